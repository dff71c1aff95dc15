"""Search for the pose at which a scan fits best, over a whole window.

Multi-resolution correlative scan matching (Olson 2009), with the branch and bound over
translations of Hess et al. (2016): the result is the best pose of the window, exactly,
whatever the start.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Pose2, angle_difference
from navette.navigation.slam.scan_points import Points
from navette.navigation.slam.score_grid import LARGEST, ScoreGrid


class SearchWindow(NamedTuple):
    """Half the extent of a search, about its centre."""

    distance_m: float
    angle_rad: float


# Half the extent of one maximum of the score.
_APART = SearchWindow(0.25, 0.06)


class SearchResult(NamedTuple):
    """The best pose, and the mean likelihood of the points there, 0 to 1."""

    pose: Pose2
    score: float


def search(
    grid: ScoreGrid,
    points: Points,
    center: Pose2,
    window: SearchWindow,
    *,
    min_score: float = 0.0,
    excluded: Sequence[Pose2] = (),
    apart: SearchWindow = _APART,
) -> SearchResult | None:
    """Return the pose with the highest score in a window, if above ``min_score``.

    The score of a pose is the mean likelihood of the points (N, 4) there. Of equal
    poses, the one nearest the centre wins, as far as the order of the search allows.

    Args:
        grid: where surfaces are.
        points: the scan in its own frame.
        center: centre of the window in the grid's frame.
        window: half its extent.
        min_score: least score.
        excluded: poses whose neighbourhood is left out, to find other maxima.
        apart: half the extent of that neighbourhood.
    """
    if not len(points):
        return None
    reach = float(np.quantile(np.hypot(points[:, 0], points[:, 1]), 0.9))
    step = grid.resolution / max(reach, 4.0 * grid.resolution)
    turns = math.ceil(window.angle_rad / step)
    cells = math.ceil(window.distance_m / grid.resolution)
    best = np.array([-1.0, 0.0, 0.0, 0.0])
    # Relative to the centre, in cells and turns, with half their extents.
    left_out = np.array(
        [
            (
                (each.x - center.x) / grid.resolution,
                (each.y - center.y) / grid.resolution,
                angle_difference(each.yaw, center.yaw) / step,
                apart.distance_m / grid.resolution,
                apart.angle_rad / step,
                math.tau / step,
            )
            for each in excluded
        ]
    ).reshape(-1, 6)
    _search_kernel(
        grid, points, np.array(center), turns, step, cells, min_score, left_out, best
    )
    if best[0] < 0.0:
        return None
    pose = Pose2(
        center.x + best[1] * grid.resolution,
        center.y + best[2] * grid.resolution,
        center.yaw + best[3] * step,
    )
    return SearchResult(pose, float(best[0]))


@kernel
def _search_kernel(
    grid: ScoreGrid,
    points: Points,
    center: NDArray[np.float64],
    turns: int,
    step: float,
    cells: int,
    min_score: float,
    left_out: NDArray[np.float64],
    best: NDArray[np.float64],
) -> None:
    """Write score, columns, rows and turns of the best pose into ``best``."""
    top = 0
    while top + 1 < grid.levels.shape[0] and (2 << top) <= cells + 1:
        top += 1
    side = (2 * cells + (1 << top)) // (1 << top)
    angles = 2 * turns + 1
    cols, rows = _turned(grid, points, center, angles, step)
    blocks = np.empty((angles * side * side, 4), np.int32)
    sums = np.empty(blocks.shape[0], np.int64)
    for i in range(blocks.shape[0]):
        k, cell = i // (side * side), i % (side * side)
        dx, dy = -cells + (cell // side << top), -cells + (cell % side << top)
        blocks[i, 0], blocks[i, 1], blocks[i, 2], blocks[i, 3] = k, dx, dy, top
        sums[i] = _sum(grid.levels[top], cols[k], rows[k], dx, dy, 1 << top)
    least = np.int64(min_score * LARGEST * points.shape[0])
    stack = np.empty((4 * (top + 2), 4), np.int32)
    bounds = np.empty(4 * (top + 2), np.int64)
    for at in np.argsort(-sums, kind="mergesort"):
        if sums[at] <= least:
            break
        stack[0], bounds[0] = blocks[at], sums[at]
        depth = 1
        while depth:
            depth -= 1
            if bounds[depth] <= least:
                continue
            if stack[depth, 3] == 0:
                if _is_left_out(left_out, stack[depth]):
                    continue
                least = bounds[depth]
                k = stack[depth, 0]
                best[0] = least / (LARGEST * points.shape[0])
                best[1], best[2] = stack[depth, 1], stack[depth, 2]
                best[3] = _turn_of(k)
            else:
                depth = _branch(
                    grid, cols, rows, cells, int(least), stack, bounds, depth
                )


@kernel(allocates=False)
def _is_left_out(left_out: NDArray[np.float64], found: NDArray[np.int32]) -> bool:
    turn = _turn_of(found[0])
    for i in range(left_out.shape[0]):
        x, y, yaw, distance, angle, whole = left_out[i]
        away = abs(turn - yaw)
        if (
            math.hypot(found[1] - x, found[2] - y) <= distance
            and min(away, whole - away) <= angle
        ):
            return True
    return False


@kernel
def _turned(
    grid: ScoreGrid,
    points: Points,
    center: NDArray[np.float64],
    angles: int,
    step: float,
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Return the cells (A, N) of the points at the centre, at each angle."""
    cols = np.empty((angles, points.shape[0]), np.int32)
    rows = np.empty((angles, points.shape[0]), np.int32)
    for k in range(angles):
        yaw = center[2] + _turn_of(k) * step
        c, s = math.cos(yaw), math.sin(yaw)
        for i in range(points.shape[0]):
            x = center[0] + c * points[i, 0] - s * points[i, 1]
            y = center[1] + s * points[i, 0] + c * points[i, 1]
            cols[k, i] = math.floor((x - grid.x) / grid.resolution)
            rows[k, i] = math.floor((y - grid.y) / grid.resolution)
    return cols, rows


@kernel(allocates=False)
def _turn_of(k: int) -> int:
    """Return the k-th angle in steps, from the centre outwards: 0, 1, −1, 2, …"""
    return (k + 1) // 2 if k % 2 else -(k // 2)


@kernel
def _branch(
    grid: ScoreGrid,
    cols: NDArray[np.int32],
    rows: NDArray[np.int32],
    cells: int,
    least: int,
    stack: NDArray[np.int32],
    bounds: NDArray[np.int64],
    depth: int,
) -> int:
    """Replace the block at ``depth`` by its four parts; return the new depth."""
    k, dx, dy = stack[depth, 0], stack[depth, 1], stack[depth, 2]
    level = stack[depth, 3] - 1
    half = 1 << level
    first = depth
    for child in range(4):
        x, y = dx + half * (child % 2), dy + half * (child // 2)
        if x > cells or y > cells:
            continue
        total = _sum(grid.levels[level], cols[k], rows[k], x, y, half)
        if total <= least:
            continue
        # Insert by ascending bound: the best part is taken first.
        place = depth
        while place > first and bounds[place - 1] > total:
            bounds[place] = bounds[place - 1]
            stack[place] = stack[place - 1]
            place -= 1
        bounds[place] = total
        stack[place, 0], stack[place, 1] = k, x
        stack[place, 2], stack[place, 3] = y, level
        depth += 1
    return depth


@kernel(allocates=False)
def _sum(
    level: NDArray[np.uint8],
    cols: NDArray[np.int32],
    rows: NDArray[np.int32],
    dx: int,
    dy: int,
    block: int,
) -> int:
    """Sum of a level at the shifted cells; a block may begin outside the grid."""
    height, width = level.shape
    total = 0
    for i in range(cols.size):
        c, r = cols[i] + dx, rows[i] + dy
        if -block < c < width and -block < r < height:
            total += level[max(r, 0), max(c, 0)]
    return total
