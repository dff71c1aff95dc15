"""Observations are in their space; shortest paths are bounded by straight lines."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from navette.geometry import Pose2
from navette.navigation.gym import Observer
from navette.navigation.gym.route import FreeSpace, Route

Cells = NDArray[Any]

OBSERVER = Observer(
    beams=7,
    angle_min=-2.0,
    angle_max=2.0,
    range_max_m=10.0,
    base_T_scan=Pose2(0.1, 0.0, 0.0),
    forward_mps=2.0,
    reverse_mps=0.5,
    turn_radps=1.5,
)
SPACE = OBSERVER.observation_space()
# Two walls with a gap each: paths wind between them.
BOX = FreeSpace(
    [
        np.array([[-3.0, 1.0], [2.0, 1.0], [2.0, 1.2], [-3.0, 1.2]]),
        np.array([[-2.0, -1.0], [3.0, -1.0], [3.0, -0.8], [-2.0, -0.8]]),
    ],
    [(-3.0, -3.0), (3.0, 3.0)],
)
ROUTE = Route(BOX, (0.0, 2.5), 0.2)

anything = st.floats(allow_nan=False, allow_infinity=False, width=32)
numbers = st.floats(-1e6, 1e6)
ranges = st.lists(st.floats(width=32), min_size=7, max_size=40)
places = st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))


@given(ranges, numbers, numbers, numbers, st.tuples(numbers, numbers), anything)
def test_observations_are_in_their_space(
    scan: list[float],
    x: float,
    y: float,
    yaw: float,
    goal: tuple[float, float],
    speed: float,
) -> None:
    pose = Pose2(x, y, math.remainder(yaw, math.tau))
    observed = OBSERVER.observe(np.array(scan, np.float32), pose, goal, (speed, -speed))
    assert observed in SPACE


@given(st.lists(st.floats(0.0, 9.0), min_size=7, max_size=40))
def test_every_beam_is_in_one_sector(scan: list[float]) -> None:
    reduced = OBSERVER.reduce(np.array(scan))
    assert reduced.min() == np.float32(min(scan))
    assert set(reduced.tolist()) <= set(np.float32(scan).tolist())
    far = np.full(len(scan), 9.5)
    for beam in range(len(scan)):
        near = far.copy()
        near[beam] = 1.0
        assert (OBSERVER.reduce(near) == 1.0).sum() == 1


@given(st.tuples(anything, anything))
def test_commands_are_within_the_limits(action: tuple[float, float]) -> None:
    v, w = OBSERVER.command(np.array(action, np.float32))
    assert -0.5 <= v <= 2.0
    assert abs(w) <= 1.5
    assert math.copysign(1.0, v) == math.copysign(1.0, action[0]) or v == 0


@given(places)
def test_a_path_is_longer_than_the_straight_line(at: tuple[float, float]) -> None:
    length_m = ROUTE.distance(at)
    if math.isinf(length_m):
        assert BOX.room_m[BOX.spec.cell_of(*at)] < 0.2  # in or at a wall
    else:
        assert length_m >= math.dist(at, ROUTE.goal) - BOX.spec.resolution


@given(places, st.floats(0.2, 3.0))
def test_the_point_ahead_is_nearer_by_the_lookahead(
    at: tuple[float, float], lookahead_m: float
) -> None:
    row, column = BOX.spec.cell_of(*at)
    length_m = ROUTE.length_m[row, column]
    if math.isinf(length_m):
        return
    ahead = ROUTE.ahead(at, lookahead_m)
    left_m = max(0.0, length_m - lookahead_m)
    assert ROUTE.distance(ahead) == pytest.approx(left_m, abs=0.08)
    assert math.dist(at, ahead) <= lookahead_m + 0.15


def test_lengths_agree_with_another_implementation() -> None:
    free = BOX.room_m >= 0.2
    number = np.arange(free.size).reshape(free.shape)
    links: list[tuple[int, int, float]] = []
    for rows, columns in ((0, 1), (1, 0), (1, 1), (1, -1)):
        here, there = _shifted(number, rows, columns)
        open_ = _open(free, rows, columns)
        edge_m = BOX.spec.resolution * math.hypot(rows, columns)
        links += [
            (int(a), int(b), edge_m)
            for a, b in zip(here[open_], there[open_], strict=True)
        ]
    a, b, edge = np.array(links).T
    graph = coo_array((edge, (a.astype(int), b.astype(int))), (free.size, free.size))
    goal = number[BOX.spec.cell_of(*ROUTE.goal)]
    expected = dijkstra(graph.tocsr(), directed=False, indices=goal)
    np.testing.assert_allclose(
        np.where(free, expected.reshape(free.shape), math.inf), ROUTE.length_m, 1e-4
    )


def _shifted(cells: Cells, rows: int, columns: int) -> tuple[Cells, Cells]:
    """Return each cell and its neighbour, as two arrays of one shape."""
    height, width = cells.shape
    left, right = max(0, -columns), width - max(0, columns)
    here = cells[: height - rows, left:right]
    return here, cells[rows:, left + columns : right + columns]


def _open(free: Cells, rows: int, columns: int) -> Cells:
    """Return whether a move between neighbours cuts no closed corner."""
    here, there = _shifted(free, rows, columns)
    if not (rows and columns):
        return here & there
    height, width = free.shape
    left, right = max(0, -columns), width - max(0, columns)
    above = free[rows:, left:right]
    beside = free[: height - rows, left + columns : right + columns]
    return here & there & above & beside
