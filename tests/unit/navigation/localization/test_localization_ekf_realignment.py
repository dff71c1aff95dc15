"""Pose from positions along an estimated path: accuracy, covariance, refusals."""

import math

import numpy as np
import pytest

from navette.geometry import Pose2, angle_difference
from navette.navigation.localization.ekf.measurement import Measurement
from navette.navigation.localization.ekf.realignment import Realignment
from navette.navigation.localization.ekf.state import SIZE, YAW, Array, X, Y

LEVER = (0.3, 0.1)
#: The true pose of the estimate's frame: what the filter is wrong by.
MOVED = Pose2(7.0, -3.0, 2.5)


def state_of(pose: Pose2) -> Array:
    state = np.zeros(SIZE)
    state[[X, Y, YAW]] = pose
    return state


def position(true: Pose2, noise: Array, stddev_m: float) -> Measurement:
    antenna = true.apply(np.array([LEVER]))[0]
    covariance = np.eye(2) * stddev_m**2
    return Measurement("gps0", 0, (X, Y), antenna + noise, covariance, lever=LEVER)


def driven(
    rng: np.random.Generator, path: list[Pose2], stddev_m: float
) -> tuple[Realignment, Pose2]:
    """Return the positions along an estimated path, and the true pose at its end."""
    realignment = Realignment()
    for estimated in path:
        noise = stddev_m * rng.standard_normal(2)
        realignment.add(
            state_of(estimated), position(MOVED @ estimated, noise, stddev_m)
        )
    return realignment, MOVED @ path[-1]


def bend(count: int, step_m: float) -> list[Pose2]:
    pose, path = Pose2(0.0, 0.0, 0.0), []
    for number in range(count):
        path.append(pose)
        pose = pose @ Pose2(step_m, 0.0, 0.02 * math.sin(number / 5))
    return path


def test_errors_are_as_large_as_the_covariance_states() -> None:
    rng, squared = np.random.default_rng(0), []
    path = bend(60, 0.2)
    for _ in range(200):
        realignment, true = driven(rng, path, 0.5)
        found = realignment.solve(state_of(path[-1]))
        assert found is not None
        pose, covariance = found
        turn = angle_difference(pose.yaw, true.yaw)
        error = np.array([pose.x - true.x, pose.y - true.y, turn])
        squared.append(float(error @ np.linalg.solve(covariance, error)))
        assert abs(turn) < 0.15
    assert 2.3 < np.mean(squared) < 3.3


def test_a_robot_that_stands_shows_no_heading() -> None:
    rng = np.random.default_rng(1)
    path = [Pose2(1.0, 2.0, 0.5)] * 60
    realignment, true = driven(rng, path, 0.01)
    assert realignment.solve(state_of(path[-1])) is None
    # The antenna beside the centre shows it when the robot turns in place.
    turning = [Pose2(1.0, 2.0, 0.1 * number) for number in range(60)]
    realignment, true = driven(rng, turning, 0.01)
    found = realignment.solve(state_of(turning[-1]))
    assert found is not None
    assert found[0] == pytest.approx(true, abs=0.02)


def test_a_compass_gives_the_heading_of_a_robot_that_stands() -> None:
    rng = np.random.default_rng(2)
    turned = MOVED.yaw
    path = [Pose2(1.0, 2.0, 0.0)] * 12
    realignment, true = driven(rng, path, 0.5)
    measured = Pose2(1.0, 2.0, turned)
    found = realignment.solve(state_of(measured), yaw_variance=0.02**2)
    # The positions are of the estimates before: the heading is that of the compass.
    assert found is not None
    pose, covariance = found
    assert angle_difference(pose.yaw, turned) == pytest.approx(0.0, abs=0.1)
    assert math.dist(pose[:2], true[:2]) < 1.0
    assert math.sqrt(covariance[0, 0]) == pytest.approx(0.5 / math.sqrt(12), rel=0.1)


def test_too_few_positions_and_a_short_path_are_not_enough() -> None:
    rng = np.random.default_rng(3)
    realignment, _ = driven(rng, bend(9, 1.0), 0.01)
    assert realignment.solve(state_of(bend(9, 1.0)[-1])) is None
    path = bend(30, 0.02)
    realignment, _ = driven(rng, path, 0.5)
    assert realignment.solve(state_of(path[-1])) is None


def test_positions_that_do_not_fit_the_path_are_less_certain() -> None:
    """Dead reckoning that slips by more than the noise of an exact receiver."""
    path, stddev_m = bend(60, 0.2), []
    for scale in (1.0, 1.02):
        rng, realignment = np.random.default_rng(4), Realignment()
        for estimated in path:
            driven_pose = Pose2(estimated.x * scale, estimated.y, estimated.yaw)
            noise = 0.01 * rng.standard_normal(2)
            seen = position(MOVED @ driven_pose, noise, 0.01)
            realignment.add(state_of(estimated), seen)
        found = realignment.solve(state_of(path[-1]))
        assert found is not None
        stddev_m.append(math.sqrt(found[1][0, 0]))
    assert stddev_m[1] > 3 * stddev_m[0]
