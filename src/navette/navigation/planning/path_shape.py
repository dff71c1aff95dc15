"""The shape of a path: headings, smoothing, turns in place, cost.

A path is an array (N, 3) of x, y, yaw in metres and radians in the map frame. A heading
opposite to the direction of travel means reverse. Poses at one position with different
headings mean a turn in place.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Pose2, wrap_angles
from navette.navigation.grids import DistanceGrid, distance_at, grid_frame
from navette.navigation.planning.planning_grid import PlanningGrid

Poses = NDArray[np.float64]
Points = NDArray[np.float64]

TURN_STEP = 0.2
"""Largest change of heading between poses of a turn in place, radians."""
# Largest distance between the poses of a bend: a check of them misses no obstacle.
_BEND_STEP_M = 0.2
_SAME_PLACE = 1e-6


def resample(points: Points, spacing: float) -> Points:
    """Return evenly spaced points on a polyline (N, 2), at most ``spacing`` apart."""
    steps = np.hypot(*np.diff(points, axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    count = max(1, math.ceil(along[-1] / spacing - 1e-9))
    at = np.linspace(0.0, along[-1], count + 1)
    return np.column_stack(
        [np.interp(at, along, points[:, 0]), np.interp(at, along, points[:, 1])]
    )


def smooth(points: Points, grid: PlanningGrid, keep_m: float) -> Points:
    """Round the corners of evenly spaced points (N, 2); the ends stay.

    Each point moves towards the midpoint of its neighbours, repeatedly (the heat
    equation), unless that would bring it closer than ``keep_m`` to an obstacle and
    closer than before.
    """
    rounded = points.copy()
    distances = DistanceGrid(grid.distances, grid_frame(grid.spec), np.inf)
    _smooth(rounded, distances, keep_m, 60, np.empty(len(points)))
    return rounded


def headed(points: Points) -> Poses:
    """Return points (N, 2) as poses (N, 3), each facing the next one."""
    steps = np.diff(points, axis=0)
    yaw = np.arctan2(steps[:, 1], steps[:, 0])
    return np.column_stack([points, np.append(yaw, yaw[-1])])


def turn_in_place(
    x: float, y: float, yaw: float, to_yaw: float, *, long_way: bool = False
) -> Poses:
    """Return poses (N, 3) from one heading to another, both included."""
    turn = math.remainder(to_yaw - yaw, math.tau)
    if long_way:
        turn -= math.copysign(math.tau, turn)
    count = max(1, math.ceil(abs(turn) / TURN_STEP))
    angles = wrap_angles(yaw + turn * np.arange(count + 1) / count)
    return np.column_stack([np.full(count + 1, x), np.full(count + 1, y), angles])


def bend(start: Pose2, turn: float, length_m: float) -> Poses:
    """Return poses (N, 3) of an arc that turns by ``turn`` (rad), ``start`` included.

    A negative length is driven in reverse.
    """
    steps = max(abs(turn) / TURN_STEP, abs(length_m) / _BEND_STEP_M)
    count = max(1, math.ceil(steps))
    share = np.arange(count + 1) / count
    half = 0.5 * turn * share
    chord = length_m * share * np.sinc(half / np.pi)
    x = start.x + chord * np.cos(start.yaw + half)
    y = start.y + chord * np.sin(start.yaw + half)
    yaw = wrap_angles(start.yaw + turn * share)
    return np.column_stack([x, y, yaw])


def joined(*pieces: Poses) -> Poses:
    """Concatenate pieces without repeating a pose at the joints."""
    whole = np.concatenate([piece for piece in pieces if len(piece)])
    same = np.all(np.abs(np.diff(whole, axis=0)) < _SAME_PLACE, axis=1)
    kept: Poses = whole[np.concatenate([[True], ~same])]
    return kept


def lengths(poses: Poses) -> NDArray[np.float64]:
    """Return (N − 1,) metres between successive poses."""
    steps = np.diff(poses[:, :2], axis=0)
    return np.hypot(steps[:, 0], steps[:, 1])


def turns(poses: Poses) -> NDArray[np.float64]:
    """Return (N − 1,) |change of heading| of turns in place, 0 elsewhere."""
    change = np.abs(wrap_angles(np.diff(poses[:, 2])))
    return np.where(lengths(poses) < _SAME_PLACE, change, 0.0)


def directions(poses: Poses) -> NDArray[np.int8]:
    """Return (N − 1,) 1 forward, −1 reverse, 0 turning in place."""
    steps = np.diff(poses[:, :2], axis=0)
    # The heading at half of an arc is the direction of its chord.
    yaw = poses[:-1, 2] + 0.5 * wrap_angles(np.diff(poses[:, 2]))
    ahead = steps[:, 0] * np.cos(yaw) + steps[:, 1] * np.sin(yaw)
    sign = np.where(ahead >= 0, 1, -1).astype(np.int8)
    sign[lengths(poses) < _SAME_PLACE] = 0
    return sign


def path_cost(
    poses: Poses,
    grid: PlanningGrid,
    *,
    turn_cost_m_per_rad: float,
    reverse_factor: float,
) -> float:
    """Return the cost of the path, in metres of free driving forward."""
    if len(poses) < 2:
        return 0.0
    cells = np.floor(grid.to_cells(poses[1:, :2])).astype(np.int64)
    cells = np.clip(cells, 0, (grid.spec.width - 1, grid.spec.height - 1))
    factor = grid.factor_at(cells[:, 1], cells[:, 0])
    factor = np.where(directions(poses) < 0, factor * reverse_factor, factor)
    return float(
        (lengths(poses) * factor).sum() + turn_cost_m_per_rad * turns(poses).sum()
    )


@kernel
def _smooth(
    points: Any, grid: DistanceGrid, keep_m: float, rounds: int, clear: Any
) -> None:
    n = points.shape[0]
    for i in range(n):
        clear[i] = distance_at(grid, points[i, 0], points[i, 1])
    for _ in range(rounds):
        for i in range(1, n - 1):
            x = 0.5 * points[i, 0] + 0.25 * (points[i - 1, 0] + points[i + 1, 0])
            y = 0.5 * points[i, 1] + 0.25 * (points[i - 1, 1] + points[i + 1, 1])
            there = distance_at(grid, x, y)
            if there >= keep_m or there >= clear[i]:
                points[i, 0], points[i, 1], clear[i] = x, y, there
