"""Consistency of the filter with the simulator's noise: normalised errors (NEES)."""

import math
from dataclasses import dataclass, field

import numpy as np
import pytest
from numpy.typing import NDArray

from navette.geometry import Pose2, angle_difference
from navette.msgs.geometry_msgs.msg import Twist
from navette.msgs.nav_msgs.msg import Odometry
from navette.navigation.localization.ekf.node import EkfNode
from navette.navigation.stack.localization_params import localization_parameters
from navette.navigation.stack.robot import simulate_robot
from navette.runtime import Context, Executor, Node, VirtualClock, stamp_to_ns
from navette.runtime.stage.path_messages import pose_of

RUNS, SECONDS = 6, 20.0
# 95 % of a chi-square variable of 3 · RUNS degrees of freedom, per run.
LOW, HIGH = 1.37, 5.25
PLANAR = np.ix_([0, 1, 5], [0, 1, 5])

#: Driven speed (m/s) and yaw rate (rad/s) of each robot.
SPEEDS = {
    "jackal": (0.8, 0.8),  # skids
    "racecar": (1.0, 0.6),  # Ackermann
    "mecanum": (0.5, 0.6),
}


@dataclass
class Drive:
    """Estimates, and the true pose by stamp."""

    estimates: list[Odometry] = field(default_factory=list)
    true: dict[int, Pose2] = field(default_factory=dict)

    def note(self, message: Odometry) -> None:
        pose = pose_of(message.pose.pose)
        self.true[stamp_to_ns(message.header.stamp)] = pose

    def normalised_errors(self) -> list[float]:
        """Return the normalised squared error of x, y, yaw once per second."""
        found, next_ns = [], 3_000_000_000
        for message in self.estimates:
            stamp_ns = stamp_to_ns(message.header.stamp)
            true = self._true_at(stamp_ns)
            if stamp_ns < next_ns or true is None:
                continue
            next_ns += 1_000_000_000
            pose = pose_of(message.pose.pose)
            turn = angle_difference(pose.yaw, true.yaw)
            error = np.array([pose.x - true.x, pose.y - true.y, turn])
            covariance = np.asarray(message.pose.covariance).reshape(6, 6)[PLANAR]
            found.append(float(error @ np.linalg.solve(covariance, error)))
        return found

    def _true_at(self, stamp_ns: int) -> Pose2 | None:
        """Return the pose at a stamp, between two that are 20 ms apart."""
        if stamp_ns in self.true:
            return self.true[stamp_ns]
        before = self.true.get(stamp_ns - 10_000_000)
        after = self.true.get(stamp_ns + 10_000_000)
        if before is None or after is None:
            return None
        step = before.inverse() @ after
        return before @ Pose2(step.x / 2, step.y / 2, step.yaw / 2)


def driven(robot: str, localization: str, seed: int) -> NDArray[np.float64]:
    """Drive bends and turns; return the normalised errors from 3 s on."""
    context, drive = Context(clock=VirtualClock()), Drive()
    speed, yaw_rate = SPEEDS[robot]
    with context:
        noise = {
            "localization": localization,
            "wheel_noise_m": 0.01,
            "imu_turn_rate_noise_radps": 0.02,
            "seed": seed,
        }
        context.overrides.add("sim", noise, "test")
        sim = simulate_robot("empty", robot, start=Pose2(0, 0, 0), context=context)
        found = localization_parameters(sim.params, Pose2(0, 0, 0))
        context.overrides.add("ekf", found["ekf"], "test")
        EkfNode(context=context)
        driver = Node("driver", context=context)
        driver.create_subscription(
            Odometry, "/odom/filtered", drive.estimates.append, 10
        )
        driver.create_subscription(Odometry, "/ground_truth", drive.note, 10)
        publisher = driver.create_publisher(Twist, "/cmd_vel", 10)

        def command() -> None:
            twist, now_s = Twist(), context.clock.now_ns / 1e9
            twist.linear.x = speed
            twist.angular.z = yaw_rate * math.sin(0.7 * now_s)
            publisher.publish(twist)

        driver.create_timer(0.1, command)
        executor = Executor(context=context)
        for node in context.nodes:
            executor.add_node(node)
        executor.spin_until(round(SECONDS * 1e9))
    return np.array(drive.normalised_errors())


@pytest.mark.long
@pytest.mark.parametrize(
    ("robot", "localization"),
    [(robot, "odometry+imu") for robot in SPEEDS]
    + [("jackal", "odometry+gnss"), ("jackal", "odometry+imu+gnss")],
)
def test_errors_are_as_large_as_the_filter_states(
    robot: str, localization: str
) -> None:
    found = [driven(robot, localization, seed) for seed in range(RUNS)]
    assert all(len(each) >= 16 for each in found)
    assert LOW < np.mean(found) < HIGH
