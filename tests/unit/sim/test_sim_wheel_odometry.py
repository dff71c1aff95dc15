"""Wheel odometry: the stated covariances match the errors."""

import math
from typing import Any

import numpy as np
import pytest

from navette.geometry import Pose2, Transform3
from navette.sim import messages
from navette.sim.robot_state import Motion
from navette.sim.scene import DiffDrive
from navette.sim.wheel_odometry import (
    LEAST_STDDEV,
    PlanarCovariances,
    WheelErrors,
    WheelOdometry,
)

DRIVE = DiffDrive(
    left_joints=("left",),
    right_joints=("right",),
    wheel_separation=0.5,
    wheel_radius=0.1,
)
STEP_NS = 20_000_000


def odometry(noise: float) -> WheelOdometry:
    return WheelOdometry(DRIVE, WheelErrors(noise))


def drive(
    wheels: WheelOdometry, left: float, right: float, steps: int, seed: int
) -> None:
    """Turn the wheels by ``left`` and ``right`` metres in all."""
    rng = np.random.default_rng(seed)
    radius = DRIVE.wheel_radius
    for i in range(1, steps + 1):
        turned = left / radius * i / steps, right / radius * i / steps
        wheels.update(turned, i * STEP_NS, rng)


def correlation(covariance: Any) -> Any:
    stddev = np.sqrt(np.diag(covariance))
    return covariance / np.outer(stddev, stddev)


def test_the_twist_covariance_is_that_of_the_encoders() -> None:
    wheels = odometry(0.05)
    drive(wheels, 0.3, -0.5, 5, seed=1)
    dt, s, base, least = 5 * STEP_NS * 1e-9, 0.05**2, 0.5, LEAST_STDDEV**2
    forward = s * (0.3 + 0.5) / (4 * dt**2) + least
    yaw = s * (0.3 + 0.5) / (base**2 * dt**2) + least
    both = s * (0.5 - 0.3) / (2 * base * dt**2)
    np.testing.assert_allclose(
        wheels.motion().covariance,
        [[forward, 0, both], [0, least, 0], [both, 0, yaw]],
        rtol=1e-9,
    )


@pytest.mark.parametrize(("left", "right"), [(2.0, 3.0), (-0.6, 0.6), (-1.0, -2.0)])
def test_covariances_match_the_scatter_of_drives(left: float, right: float) -> None:
    """The mean of the stated covariances equals the scatter of the end poses."""
    poses, motions, stated_poses, stated_motions = [], [], [], []
    for seed in range(300):
        wheels = odometry(0.01)
        drive(wheels, left, right, 12, seed)
        motion = wheels.motion()
        poses.append(wheels.pose)
        stated_poses.append(wheels.pose_covariance)
        motions.append((motion.speed, motion.yaw_rate))
        stated_motions.append(motion.covariance[np.ix_([0, 2], [0, 2])])
    for ends, stated in ((poses, stated_poses), (motions, stated_motions)):
        found, claimed = np.cov(np.array(ends).T), np.mean(stated, axis=0)
        ratio = np.sqrt(np.diag(claimed) / np.diag(found))
        np.testing.assert_allclose(ratio, 1.0, atol=0.12)
        np.testing.assert_allclose(correlation(claimed), correlation(found), atol=0.12)


def test_a_filter_with_known_yaw_rate_estimates_speed_without_bias() -> None:
    """Variances of the measured travel would bias the speed by s / 2 dt."""
    noise, dt, drives = 0.02, STEP_NS * 1e-9, 1600
    off = []
    for seed in range(drives):
        wheels = odometry(noise)
        drive(wheels, 0.02, 0.02, 1, seed)
        reported = wheels.motion()
        gain = reported.covariance[0, 2] / reported.covariance[2, 2]
        off.append(reported.speed - gain * reported.yaw_rate - 0.02 / dt)
    assert abs(np.mean(off)) < noise**2 / (2 * dt) / 2


def test_covariances_do_not_depend_on_the_update_rate() -> None:
    seldom, often = odometry(0.05), odometry(0.05)
    drive(seldom, 1.0, 1.4, 1, seed=1)
    drive(often, 1.0, 1.4, 100, seed=1)
    np.testing.assert_allclose(
        np.diag(often.pose_covariance)[2], np.diag(seldom.pose_covariance)[2], rtol=0.1
    )


def test_a_stationary_wheel_has_a_variance() -> None:
    wheels = odometry(0.05)
    reported = wheels.motion()
    assert (reported.speed, reported.yaw_rate) == (0.0, 0.0)
    drive(wheels, 0.0, 0.0, 3, seed=1)
    least = np.eye(3) * LEAST_STDDEV**2
    np.testing.assert_allclose(wheels.motion().covariance, least)
    np.testing.assert_allclose(wheels.pose_covariance, least)


def test_the_motion_is_the_mean_since_the_last_call() -> None:
    wheels, rng = odometry(0.0), np.random.default_rng(0)
    wheels.update((1.0, 1.0), 100_000_000, rng)
    assert wheels.motion().speed == pytest.approx(1.0)
    wheels.update((3.0, 3.0), 150_000_000, rng)
    wheels.update((4.0, 4.0), 200_000_000, rng)
    assert wheels.motion().speed == pytest.approx(3.0)
    assert wheels.motion().speed == pytest.approx(3.0)  # called again at the same time


def test_a_child_ahead_of_the_axle_swings_with_the_heading() -> None:
    planar = PlanarCovariances(np.diag([0.0, 0.0, 0.01]), np.diag([0.0, 0.0, 0.04]))
    message = messages.odometry_message(
        0,
        ("odom", "nose"),
        Transform3.from_pose2(Pose2(1.0, 2.0, math.pi / 2)),
        Motion((0.0, 0.0, 0.0), (0.0, 0.0, 0.5)),
        Transform3.from_pose2(Pose2(2.0, 0.0, math.pi / 2)),
        planar,
    )
    pose = np.reshape(message.pose.covariance, (6, 6))
    twist = np.reshape(message.twist.covariance, (6, 6))
    # The front is 2 m north of the axle and faces west.
    assert message.pose.pose.position.y == pytest.approx(4.0)
    np.testing.assert_allclose(np.diag(pose), [0.04, 0, 0, 0, 0, 0.01], atol=1e-12)
    assert pose[0, 5] == pytest.approx(-0.02)
    assert message.twist.twist.linear.x == pytest.approx(1.0)
    np.testing.assert_allclose(np.diag(twist), [0.16, 0, 0, 0, 0, 0.04], atol=1e-12)
    assert twist[0, 5] == pytest.approx(0.08)
