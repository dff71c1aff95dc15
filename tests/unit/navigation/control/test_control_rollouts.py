"""Rollouts respect the drive's limits and measure obstacles as a plain loop does."""

import math
from typing import Any

import numpy as np
import pytest

from navette.geometry import DRIVES, Footprint, Pose2, advanced
from navette.navigation.control.local_field import local_field
from navette.navigation.control.mppi import MotionState, Mppi
from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_candidates import fill_path_candidates
from navette.navigation.control.rollouts import (
    METRES_PER_RADIAN,
    PathTable,
    PathWindow,
    RolloutBody,
    _clearances,
    _near_obstacles,
    _nearest,
)
from navette.navigation.grids import body_points

DRIVE_PARAMS: dict[str, dict[str, Any]] = {
    "differential": {},
    "ackermann": {"min_turning_radius_m": 0.8},
    "omni": {"max_side_speed_mps": 0.5},
}
AT_REST = MotionState(0.0, 0.0, 0.0, 0.0, 0.0)
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


def make(drive: str, body: np.ndarray = BODY, **values: Any) -> Mppi:
    params = ControlParams(drive=drive, method="mppi", **DRIVE_PARAMS[drive], **values)
    return Mppi(params, body)


def drive_along(
    mppi: Mppi,
    path: PathWindow,
    field: Any,
    steps: int,
    state: MotionState = AT_REST,
) -> list[Any]:
    """Drive without delay; return the states."""
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


@pytest.mark.parametrize("drive", ["differential", "ackermann", "omni"])
def test_candidates_track_the_path(drive: str) -> None:
    """At half the speed, a bend of 1.5 m and the end of the path are kept."""
    angle = np.arange(0, 1.5, 0.05)
    path = PathWindow(
        1.5 * np.sin(angle), 1.5 - 1.5 * np.cos(angle), np.cos(angle), np.sin(angle),
        1.5 * angle, np.ones(len(angle), np.int8),
    )  # fmt: skip
    limits = make(drive)._limits
    table = PathTable.of(path, 0.0, 0.0, 0.1)
    parts = 3 if drive == "omni" else 2
    commands = np.zeros((100, parts, 1), np.float32)
    shares = np.array([0.5], np.float32)
    code = DRIVES.index(drive)
    fill_path_candidates(commands, 0.0, table, limits, code, shares, 0.1)
    pose, apart = Pose2(0.0, 0.0, 0.0), []
    for step in commands[:, :, 0].astype(float):
        turn = step[0] * step[1] if drive == "ackermann" else step[-1]
        side = step[1] if drive == "omni" else 0.0
        pose = advanced(pose, step[0], turn, 0.1, side=side)
        apart.append(abs(math.hypot(pose.x, pose.y - 1.5) - 1.5))
    assert max(apart) < 0.05
    assert math.dist((pose.x, pose.y), (path.x[-1], path.y[-1])) < 0.1


def test_candidates_back_up_and_turn_in_place_where_the_path_does() -> None:
    """As in front of a wall: back 4 cm, turn by 90°, and drive on."""
    back = [(-0.02 * i, 0.0, 0.0) for i in range(2)]
    turn = [(-0.04, 0.0, 0.1 * i) for i in range(16)]
    poses = np.array([*back, *turn, *[(-0.04, 0.05 * i, 1.5) for i in range(20)]])
    step = np.hypot(*np.diff(poses[:, :2], axis=0).T)
    spin = METRES_PER_RADIAN * np.abs(np.diff(poses[:, 2]))
    measure = np.concatenate([[0.0], np.cumsum(step + spin)])
    direction = np.array([-1] * 2 + [0] * 15 + [1] * 21, np.int8)
    x, y, yaw = np.ascontiguousarray(poses.T)
    path = PathWindow(x, y, np.cos(yaw), np.sin(yaw), measure, direction)
    commands = np.zeros((60, 2, 1), np.float32)
    table = PathTable.of(path, 0.0, 0.0, 0.1)
    shares, limits = np.array([0.2], np.float32), make("differential")._limits
    code = DRIVES.index("differential")
    fill_path_candidates(commands, 0.0, table, limits, code, shares, 0.1)
    pose = Pose2(0.0, 0.0, 0.0)
    for speed, rate in commands[:, :, 0].astype(float).tolist():
        pose = advanced(pose, speed, rate, 0.1)
        if pose.yaw < 1.0:
            assert -0.06 < pose.x < 0.01
            assert abs(pose.y) < 0.02, "it turns in place"
    assert pose.yaw == pytest.approx(1.5, abs=0.2)
    assert pose.y > 0.3


@pytest.mark.parametrize(("y", "yaw"), [(0.04, 0.0), (0.04, 0.19), (0.05, -0.19)])
def test_a_robot_before_a_passage_with_six_centimetres_on_each_side_enters(
    y: float, yaw: float
) -> None:
    """Nearly all noise collides there, and the mean of the rest stands."""
    along, beside = np.arange(0.4, 2.4, 0.02), np.arange(0.26, 1.5, 0.02)
    walls = [np.column_stack([along, along * 0 + sign * 0.26]) for sign in (1, -1)]
    walls += [np.column_stack([beside * 0 + 0.4, sign * beside]) for sign in (1, -1)]
    field = local_field(np.concatenate(walls), 0.05, 1.25)
    path = window(np.column_stack([np.arange(0, 4, 0.1), np.zeros(40)]))
    platform = Footprint.from_flat((-0.25, -0.2, 0.25, -0.2, 0.25, 0.2, -0.25, 0.2))
    mppi = make(
        "omni",
        body_points(platform, 0.15),
        cruise_speed_mps=0.9,
        max_speed_mps=1.0,
        mppi_clearance_m=0.15,
        mppi_heading_weight=2.0,
        mppi_reverse_weight=0.0,
    )
    states = drive_along(mppi, path, field, 160, MotionState(0.0, y, yaw, 0.0, 0.0))
    assert states[-1].x > 3.0


def random_poses(count: int, reach_m: float) -> np.ndarray:
    """Poses (4, N): x, y, cosine and sine of the heading."""
    rng = np.random.default_rng(7)
    x, y = rng.uniform(-reach_m, reach_m, (2, count))
    yaw = rng.uniform(-math.pi, math.pi, count)
    return np.array([x, y, np.cos(yaw), np.sin(yaw)], np.float32)


@pytest.mark.parametrize("exact", [True, False])
def test_no_pose_with_little_clearance_is_left_out(exact: bool) -> None:
    points = np.random.default_rng(3).uniform(-3, 3, (25, 2))
    body, enough, count = RolloutBody.of(BODY), np.float32(0.2), 5000
    field = local_field(points, 0.05, enough + body.reach_m + 0.15)
    poses = random_poses(count, 4.0)
    near = np.empty((5, count), np.float32)
    index, cells = np.empty((2, count), np.int32)
    found = _near_obstacles(poses, field, body, enough, near, index, cells)
    assert 0 < found < 0.8 * count
    every = np.empty((5, count), np.float32)
    every[:2] = (poses[:2] - np.array([[field.x], [field.y]], np.float32)) / 0.05
    every[2:4] = poses[2:] / 0.05
    _clearances(field, body, enough, every, count, exact)
    tight = np.flatnonzero(every[4] < enough)
    assert len(tight)
    assert set(tight) <= set(index[:found])
    np.testing.assert_allclose(near[:4, :found], every[:4, index[:found]], atol=1e-4)


def test_samples_advance_to_the_nearest_pose_that_they_can_reach() -> None:
    angle = np.arange(0, 3, 0.1)
    points = np.column_stack([np.sin(angle), 1 - np.cos(angle)])
    table = PathTable.of(window(points), 0.0, 0.0, 0.35)
    poses = random_poses(200, 1.5)
    at = np.arange(200, dtype=np.int32) % len(angle)
    apart = np.empty(200, np.float32)
    before = at.copy()
    _nearest(table, poses, at, apart)
    gaps = poses[:, :, None] - table.poses[:4, None]
    squared = (gaps * gaps * np.array([1, 1, 0.25, 0.25])[:, None, None]).sum(axis=0)
    for i, first in enumerate(before):
        reached = squared[i, first : first + table.reach + 1]
        assert apart[i] == pytest.approx(reached.min(), abs=1e-5)
        assert at[i] == min(first + reached.argmin(), len(angle) - 1)
