"""Consistency of the filter with the simulator's noise: normalised errors (NEES)."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from navette.geometry import Pose2, angle_difference
from navette.msgs.geometry_msgs.msg import Twist
from navette.msgs.nav_msgs.msg import Odometry
from navette.navigation.localization.ekf.node import EkfNode
from navette.navigation.stack.localization_params import localization_parameters
from navette.navigation.stack.robot import simulate_robot
from navette.runtime import Context, Executor, Node, VirtualClock
from navette.runtime.stage.path_messages import pose_of

RUNS, SECONDS = 12, 20.0
# 95 % of a chi-square variable of 3 · RUNS degrees of freedom, per run.
LOW, HIGH = 1.77, 4.55
PLANAR = np.ix_([0, 1, 5], [0, 1, 5])


def final_error(
    localization: str, seed: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Drive bends and turns; return error and covariance of x, y, yaw at the end."""
    context = Context(clock=VirtualClock())
    with context:
        noise = {
            "localization": localization,
            "wheel_noise_m": 0.01,
            "imu_turn_rate_noise_radps": 0.02,
            "seed": seed,
        }
        context.overrides.add("sim", noise, "test")
        sim = simulate_robot("empty", "jackal", start=Pose2(0, 0, 0), context=context)
        found = localization_parameters(sim.params, Pose2(0, 0, 0))
        context.overrides.add("ekf", found["ekf"], "test")
        EkfNode(context=context)
        driver = Node("driver", context=context)
        received: list[Odometry] = []
        driver.create_subscription(Odometry, "/odom/filtered", received.append, 10)
        publisher = driver.create_publisher(Twist, "/cmd_vel", 10)

        def drive() -> None:
            command, now_s = Twist(), context.clock.now_ns / 1e9
            command.linear.x = 0.8
            command.angular.z = 0.8 * math.sin(0.7 * now_s)
            publisher.publish(command)

        driver.create_timer(0.1, drive)
        executor = Executor(context=context)
        for node in context.nodes:
            executor.add_node(node)
        executor.spin_until(round(SECONDS * 1e9))
        message = received[-1]
        true, estimate = sim.simulator.pose().to_pose2(), pose_of(message.pose.pose)
        covariance = np.asarray(message.pose.covariance).reshape(6, 6)[PLANAR]
    turn = angle_difference(estimate.yaw, true.yaw)
    return np.array([estimate.x - true.x, estimate.y - true.y, turn]), covariance


@pytest.mark.long
@pytest.mark.parametrize("localization", ["odometry+imu", "odometry+imu+gnss"])
def test_errors_are_as_large_as_the_filter_states(localization: str) -> None:
    normalised = []
    for seed in range(RUNS):
        error, covariance = final_error(localization, seed)
        normalised.append(float(error @ np.linalg.solve(covariance, error)))
    assert LOW < np.mean(normalised) < HIGH
