"""Rollouts respect the drive's limits and measure obstacles as a plain loop does."""

import math
from typing import Any

import numpy as np
import pytest

from navette.geometry import DRIVES, Footprint, Pose2, advanced
from navette.navigation.control.local_field import local_field
from navette.navigation.control.mppi import MotionState, Mppi
from navette.navigation.control.params import ControlParams
from navette.navigation.control.rollouts import PathWindow
from navette.navigation.grids import body_points

DRIVE_PARAMS: dict[str, dict[str, Any]] = {
    "differential": {},
    "ackermann": {"min_turning_radius_m": 0.8},
    "omni": {"max_side_speed_mps": 0.5},
}
BODY = body_points(
    Footprint.from_flat((0.3, 0.2, -0.3, 0.2, -0.3, -0.2, 0.3, -0.2)), 0.1
)


def window(points: np.ndarray, yaw: float = 0.0) -> PathWindow:
    x, y = points.T
    measure = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    one = np.ones(len(x))
    return PathWindow(
        x.copy(), y.copy(), one * math.cos(yaw), one * math.sin(yaw), measure,
        one.astype(np.int8),
    )  # fmt: skip


def make(drive: str, **values: Any) -> Mppi:
    params = ControlParams(drive=drive, method="mppi", **DRIVE_PARAMS[drive], **values)
    return Mppi(params, BODY)


def drive_along(mppi: Mppi, path: PathWindow, field: Any, steps: int) -> list[Any]:
    """Drive without delay; return the states."""
    state = MotionState(0.0, 0.0, 0.0, 0.0, 0.0)
    states = [state]
    for _ in range(steps):
        near = int(np.argmin(np.hypot(path.x - state.x, path.y - state.y)))
        ahead = PathWindow(*(column[near:] for column in path))
        v, w, side = mppi.step(state, ahead, field, 0.05)
        pose = advanced(Pose2(*state[:3]), v, w, 0.05, side=side)
        state = MotionState(*pose, v, w, side)
        states.append(state)
    return states


OPEN = local_field(np.array([[50.0, 50.0]]), 0.1, 1.0)


@pytest.mark.parametrize("drive", DRIVES)
def test_every_drive_reaches_the_end_of_a_straight_path(drive: str) -> None:
    path = window(np.column_stack([np.arange(0, 3, 0.1), np.zeros(30)]))
    end = drive_along(make(drive), path, OPEN, 200)[-1]
    assert end.x == pytest.approx(2.9, abs=0.15)
    assert abs(end.y) < 0.1


def test_an_ackermann_drive_never_turns_tighter_than_its_radius() -> None:
    points = np.column_stack([0.3 * np.sin(np.arange(0, 3, 0.1)), np.arange(0, 3, 0.1)])
    states = drive_along(make("ackermann"), window(points, math.pi / 2), OPEN, 200)
    assert all(abs(s.turn_rate) <= abs(s.speed) / 0.8 + 1e-5 for s in states)
    assert max(abs(s.turn_rate) for s in states) > 0.2, "it does turn"


def test_an_omnidirectional_drive_moves_sideways_without_turning() -> None:
    path = window(np.column_stack([np.zeros(20), np.arange(0, 2, 0.1)]))
    mppi = make("omni", mppi_heading_weight=3.0)
    states = drive_along(mppi, path, OPEN, 200)
    assert states[-1].y == pytest.approx(1.9, abs=0.15)
    assert max(abs(s.yaw) for s in states) < 0.2
    assert max(abs(s.side) for s in states) <= 0.5 + 1e-6


@pytest.mark.parametrize("drive", DRIVES)
def test_far_from_the_origin_of_the_map_the_commands_are_the_same(drive: str) -> None:
    """Float32 has 0.5 m at UTM northings: rollouts are relative to the robot."""
    points = np.column_stack([np.arange(0, 3, 0.1), 0.2 * np.arange(0, 3, 0.1)])
    post = np.array([[1.5, -0.2], [1.6, -0.2]])
    state = MotionState(0.1, 0.05, 0.1, 0.3, 0.0)
    near = make(drive).step(state, window(points), local_field(post, 0.0625, 1.0), 0.05)
    at = np.array([2.0**19, 2.0**22])
    moved = state._replace(x=state.x + at[0], y=state.y + at[1])
    field = local_field(post + at, 0.0625, 1.0)
    far = make(drive).step(moved, window(points + at), field, 0.05)
    assert far == pytest.approx(near, abs=1e-4)


def test_a_post_beside_the_path_repels_every_corner_of_the_body() -> None:
    """The post is 0.25 m beside the middle; half of the body is 0.2 m wide."""
    path = window(np.column_stack([np.arange(0, 4, 0.1), np.zeros(40)]))
    post = np.array([[2.0, 0.25]])
    field = local_field(post, 0.02, 1.0)
    states = drive_along(make("differential"), path, field, 250)
    abeam = [s.y for s in states if 1.7 < s.x < 2.3]
    assert max(abeam) < -0.03
