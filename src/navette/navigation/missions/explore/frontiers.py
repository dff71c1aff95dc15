"""Frontiers of a map: where known free space meets unknown space.

A frontier is a connected set of free cells beside unknown ones (Yamauchi, "A
frontier-based approach for autonomous exploration", CIRA 1997). The robot drives to the
frontier whose length, as a measure of what may be seen there, is worth the distance
(Burgard et al., "Coordinated multi-robot exploration", IEEE T-RO 2005, eq. 4 with one
robot).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids import UNKNOWN, GridSpec, distance_field

Cells = NDArray[np.int8]
Mask = NDArray[np.bool_]
_UNREACHED = np.iinfo(np.int32).max


@dataclass(frozen=True)
class FrontierParams:
    """Values of the choice of a frontier.

    Attributes:
        clearance_m: distance of a goal from obstacles.
        lethal_cost: map cost from which a cell is an obstacle.
        min_length_m: shorter frontiers are ignored: noise between cells.
        viewpoint_m: largest distance from a frontier to its goal.
        gain: metres of way that a metre of frontier is worth.
    """

    clearance_m: float = 0.35
    lethal_cost: int = 100
    min_length_m: float = 0.6
    viewpoint_m: float = 2.0
    gain: float = 1.0


@dataclass(frozen=True)
class Frontier:
    """A frontier with the point to see it from (m, map).

    ``way_m`` is the distance to that point around obstacles.
    """

    goal: tuple[float, float]
    middle: tuple[float, float]
    length_m: float
    way_m: float


@dataclass(frozen=True)
class Exploration:
    """State of the exploration.

    Attributes:
        frontiers: reachable ones, the best first.
        unreachable: number of frontiers that the robot cannot get near to.
        free_m2: known free area.
        known_m2: known area.
        open_share: share of the free space's boundary that is frontier.
    """

    frontiers: tuple[Frontier, ...]
    unreachable: int
    free_m2: float
    known_m2: float
    open_share: float


def explore(
    cells: Cells,
    spec: GridSpec,
    robot: tuple[float, float],
    params: FrontierParams,
    avoid: Sequence[tuple[float, float]] = (),
) -> Exploration:
    """Return the frontiers of a map, the best first, and the explored area.

    Args:
        cells: (H, W) occupancy, -1 unknown, 0 free to 100 occupied.
        spec: geometry of the grid.
        robot: position of the robot, m, map.
        avoid: points (m, map) whose surroundings, ``viewpoint_m`` / 2, are left out:
            goals that failed.
    """
    occupied = cells >= params.lethal_cost
    free = (cells >= 0) & ~occupied
    open_edge = free & _beside(cells == UNKNOWN)
    closed_edge = free & _beside(occupied) & ~open_edge
    open_cells, closed_cells = 0, int(closed_edge.sum())
    away = distance_field(
        occupied.astype(np.uint8), spec.resolution, params.clearance_m + spec.resolution
    )
    drivable = free & (away >= params.clearance_m)
    steps = _steps_from(drivable, free, spec.cell_of(*robot))
    found, unreachable = [], 0
    for cluster in _clusters(open_edge):
        if len(cluster) * spec.resolution < params.min_length_m:
            continue
        open_cells += len(cluster)
        frontier = _viewpoint(cluster, steps, spec, params, avoid)
        if frontier is None:
            unreachable += 1
        else:
            found.append(frontier)
    found.sort(key=lambda each: (each.way_m - params.gain * each.length_m, each.goal))
    cell_m2 = spec.resolution**2
    total = open_cells + closed_cells
    return Exploration(
        frontiers=tuple(found),
        unreachable=unreachable,
        free_m2=float(free.sum()) * cell_m2,
        known_m2=float((cells >= 0).sum()) * cell_m2,
        open_share=open_cells / total if total else 0.0,
    )


def is_open(
    cells: Cells, spec: GridSpec, point: tuple[float, float], radius_m: float,
    lethal_cost: int = 100,
) -> bool:  # fmt: skip
    """Return whether a frontier is left within a radius of a point."""
    row, column = spec.cell_of(*point)
    reach = round(radius_m / spec.resolution) + 1
    rows = slice(max(row - reach, 0), max(row + reach + 1, 0))
    columns = slice(max(column - reach, 0), max(column + reach + 1, 0))
    part = cells[rows, columns]
    free = (part >= 0) & (part < lethal_cost)
    return bool((free & _beside(part == UNKNOWN)).any())


def _beside(mask: Mask) -> Mask:
    """Return the cells that have a true cell left, right, above or below."""
    found = np.zeros_like(mask)
    found[1:] |= mask[:-1]
    found[:-1] |= mask[1:]
    found[:, 1:] |= mask[:, :-1]
    found[:, :-1] |= mask[:, 1:]
    return found


def _diagonal_to(mask: Mask) -> Mask:
    """Return the cells that have a true cell at a corner."""
    found = np.zeros_like(mask)
    found[1:, 1:] |= mask[:-1, :-1]
    found[1:, :-1] |= mask[:-1, 1:]
    found[:-1, 1:] |= mask[1:, :-1]
    found[:-1, :-1] |= mask[1:, 1:]
    return found


def _steps_from(
    drivable: Mask, free: Mask, start: tuple[int, int]
) -> NDArray[np.int32]:
    """Return the number of steps (H, W) from a cell through drivable ones.

    Steps alternate between four and eight neighbours, so that their number is near to
    the Euclidean distance (octagonal distance). A start within the clearance of an
    obstacle leaves it through free cells.
    """
    steps = np.full(drivable.shape, _UNREACHED, np.int32)
    height, width = drivable.shape
    if not (0 <= start[0] < height and 0 <= start[1] < width):
        return steps
    front = np.zeros_like(drivable)
    front[start] = True
    seen = front.copy()
    count = 0
    while front.any():
        steps[front] = count
        count += 1
        grown = _beside(front)
        if count % 2 == 0:
            grown |= _diagonal_to(front)
        # Only until the first drivable cell may the way lead through other free ones.
        allowed = drivable if (seen & drivable).any() else free
        front = grown & allowed & ~seen
        seen |= front
    return steps


def _clusters(mask: Mask) -> list[NDArray[np.int64]]:
    """Return the connected sets (eight neighbours) of true cells, as (N, 2) indices."""
    left = {(int(r), int(c)) for r, c in np.argwhere(mask)}
    found = []
    while left:
        # Row by row, so that the order depends on the map only.
        first = min(left)
        left.discard(first)
        cluster, waiting = [first], [first]
        while waiting:
            row, column = waiting.pop()
            for dr in (-1, 0, 1):
                for dc in (-1, 0, 1):
                    near = (row + dr, column + dc)
                    if near in left:
                        left.discard(near)
                        cluster.append(near)
                        waiting.append(near)
        found.append(np.array(sorted(cluster), np.int64))
    return found


def _viewpoint(
    cluster: NDArray[np.int64],
    steps: NDArray[np.int32],
    spec: GridSpec,
    params: FrontierParams,
    avoid: Sequence[tuple[float, float]],
) -> Frontier | None:
    """Return the frontier with the reachable point nearest to its middle."""
    mean = cluster.mean(axis=0)
    middle = cluster[np.argmin(((cluster - mean) ** 2).sum(axis=1))]
    reach = round(params.viewpoint_m / spec.resolution)
    low = np.maximum(middle - reach, 0)
    window = steps[low[0] : middle[0] + reach + 1, low[1] : middle[1] + reach + 1]
    candidates = np.argwhere(window < _UNREACHED)
    if not len(candidates):
        return None
    candidates = candidates + low
    off = ((candidates - middle) ** 2).sum(axis=1)
    centers = spec.centers_of(candidates)
    allowed = off <= reach**2
    for x, y in avoid:
        near = params.viewpoint_m / 2
        allowed &= ((centers - (x, y)) ** 2).sum(axis=1) > near**2
    if not allowed.any():
        return None
    best = int(np.argmin(np.where(allowed, off, np.iinfo(np.int64).max)))
    row, column = candidates[best]
    return Frontier(
        goal=(float(centers[best, 0]), float(centers[best, 1])),
        middle=spec.center_of(int(middle[0]), int(middle[1])),
        length_m=len(cluster) * spec.resolution,
        way_m=float(steps[row, column]) * spec.resolution,
    )
