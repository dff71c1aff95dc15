"""Jumps of the odometry, which move its frame and not the robot."""

import math

import numpy as np
import pytest

from navette.geometry import Pose2, angle_difference
from navette.navigation.localization.amcl.odometry_jumps import OdometryJumps

PERIOD_NS = 100_000_000
STEP = Pose2(0.1, 0.0, 0.05)  # 1 m/s, 0.5 rad/s


def driven(jumps: OdometryJumps, pose: Pose2, steps: int, start: int = 0) -> Pose2:
    for number in range(start, start + steps):
        assert jumps.step(pose, number * PERIOD_NS) is None
        pose = pose @ STEP
    return pose


@pytest.mark.parametrize(
    "by", [Pose2(0.7, 0.3, 0.4), Pose2(-3.0, 2.0, 3.0), Pose2(0.0, 0.0, -1.0)]
)
def test_a_jump_is_found_and_undone(by: Pose2) -> None:
    jumps = OdometryJumps()
    pose = driven(jumps, Pose2(1.0, 2.0, 0.3), 10)
    new_T_old = jumps.step(pose @ by, 10 * PERIOD_NS)
    assert new_T_old is not None
    undone = new_T_old.inverse() @ pose @ by
    assert undone.distance_to(pose) < 0.2  # the robot's own motion
    assert abs(angle_difference(undone.yaw, pose.yaw)) < 0.1
    driven(jumps, pose @ by @ STEP, 10, 11)


def test_hard_braking_gaps_and_fast_robots_do_not_jump() -> None:
    rng = np.random.default_rng(0)
    jumps, pose, speed_mps, now_ns = OdometryJumps(), Pose2(0.0, 0.0, 0.0), 0.0, 0
    for _ in range(500):
        dt = float(rng.choice([0.02, 0.1, 0.4]))
        before = speed_mps
        speed_mps = float(np.clip(before + rng.uniform(-8, 8) * dt, -3.0, 12.0))
        mean_mps = (before + speed_mps) / 2
        pose = pose @ Pose2(mean_mps * dt, 0.0, rng.uniform(-3, 3) * dt)
        now_ns += round(dt * 1e9)
        assert jumps.step(pose, now_ns) is None
    assert math.isfinite(pose.x)


def test_stamps_that_repeat_are_ignored() -> None:
    jumps = OdometryJumps()
    assert jumps.step(Pose2(0.0, 0.0, 0.0), PERIOD_NS) is None
    assert jumps.step(Pose2(9.0, 0.0, 0.0), PERIOD_NS) is None
