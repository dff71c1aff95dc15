"""Frontiers of a map: where known free space meets unknown space.

A frontier is a connected set of free cells beside unknown ones (Yamauchi, "A
frontier-based approach for autonomous exploration", CIRA 1997). The robot drives to the
frontier whose length, as a measure of what may be seen there, is worth the distance
(Burgard et al., "Coordinated multi-robot exploration", IEEE T-RO 2005, eq. 4 with one
robot).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids import UNKNOWN, CellWindow, GridSpec, distance_field
from navette.navigation.missions.explore.waves import (
    UNREACHED,
    CellIndices,
    Mask,
    connected_sets,
    first_that_sees,
    steps_from,
    steps_to,
)

Cells = NDArray[np.int8]
_WALL_M = 0.1
"""Cells as near to an obstacle belong to it: thickness and noise of walls."""


@dataclass(frozen=True)
class FrontierParams:
    """Values of the choice of a frontier.

    Attributes:
        clearance_m: distance of a goal from obstacles.
        lethal_cost: map cost from which a cell is an obstacle.
        min_length_m: shorter frontiers are ignored: noise between cells.
        max_length_m: longer frontiers are divided.
        passage_m: distance from obstacles that the robot needs to pass between them.
        viewpoint_m: largest distance from a frontier to its goal, along free cells.
        gain: metres of path that compensate for a metre of frontier.
    """

    clearance_m: float = 0.35
    lethal_cost: int = 100
    min_length_m: float = 0.6
    viewpoint_m: float = 2.0
    gain: float = 1.0
    max_length_m: float = 4.0
    passage_m: float = 0.3


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
    *,
    failed: Sequence[Frontier] = (),
    visited: Sequence[Frontier] = (),
) -> Exploration:
    """Return the frontiers of a map, the best first, and the explored area.

    Args:
        cells: (H, W) occupancy, -1 unknown, 0 free to 100 occupied.
        spec: geometry of the grid.
        robot: position of the robot, m, map.
        failed: frontiers that were not reached; those near to them are left out.
        visited: frontiers that were still there when their goal was reached. Those near
            to them are left out unless they are to be seen from another place.
    """
    window = CellWindow.of_known(cells).grown(1, cells.shape)
    corner = np.array((window.first_row, window.first_column))
    known = np.ascontiguousarray(cells[window.slices])
    free, occupied, away = _layers(known, spec.resolution, params)
    open_edge = _open_edge(known, free, away)
    closed_edge = free & _beside(occupied) & ~open_edge
    open_cells, closed_cells = 0, int(closed_edge.sum())
    # A start within the clearance of an obstacle leaves it through free cells.
    passable = free & (away >= min(params.passage_m, params.clearance_m))
    row, column = (spec.cell_of(*robot) - corner).tolist()
    steps = steps_from((row, column), free, passable)
    steps[away < params.clearance_m] = UNREACHED  # passed, but no place to look from
    longest = max(1, round(params.max_length_m / spec.resolution))
    found, unreachable = [], 0
    for cluster in connected_sets(open_edge):
        if len(cluster) * spec.resolution < params.min_length_m:
            continue
        open_cells += len(cluster)
        for piece in _pieces(cluster, longest):
            frontier = _viewpoint(piece, free, occupied, steps, spec, corner, params)
            if frontier is not None and _is_hopeless(
                frontier, failed, visited, params.viewpoint_m / 4
            ):
                frontier = None
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
        known_m2=float((known >= 0).sum()) * cell_m2,
        open_share=open_cells / total if total else 0.0,
    )


def is_open(
    cells: Cells, spec: GridSpec, frontier: Frontier, params: FrontierParams
) -> bool:
    """Return whether a good part of a frontier is left near to its middle."""
    row, column = spec.cell_of(*frontier.middle)
    radius_m = max(params.min_length_m, frontier.length_m / 4)
    reach = round(radius_m / spec.resolution) + 1
    edge = reach + round(_WALL_M / spec.resolution) + 1  # cells whose walls count
    rows = slice(max(row - edge, 0), max(row + edge + 1, 0))
    columns = slice(max(column - edge, 0), max(column + edge + 1, 0))
    part = cells[rows, columns]
    if not part.size:
        return False
    free, _, away = _layers(part, spec.resolution, params)
    left = np.argwhere(_open_edge(part, free, away))
    middle = row - rows.start, column - columns.start
    near = int((np.abs(left - middle).max(axis=1) <= reach).sum()) if len(left) else 0
    return near * spec.resolution >= min(params.min_length_m, frontier.length_m) / 2


def _layers(
    cells: Cells, resolution: float, params: FrontierParams
) -> tuple[Mask, Mask, NDArray[np.float32]]:
    """Return free cells, occupied cells, and the distance to occupied ones (m)."""
    occupied = cells >= params.lethal_cost
    reach_m = max(params.clearance_m, _WALL_M) + resolution
    away = distance_field(occupied.astype(np.uint8), resolution, reach_m)
    return (cells >= 0) & ~occupied, occupied, away


def _open_edge(cells: Cells, free: Mask, away: NDArray[np.float32]) -> Mask:
    """Return the cells of frontiers: free, beside unknown ones, not within a wall.

    A wall is a line of occupied cells with gaps; behind it are cells that are known by
    their inflation only.
    """
    return free & _beside(cells == UNKNOWN) & (away > _WALL_M)


def _is_hopeless(
    frontier: Frontier,
    failed: Sequence[Frontier],
    visited: Sequence[Frontier],
    near_m: float,
) -> bool:
    """Whether another drive to the frontier promises nothing."""
    return any(math.dist(frontier.middle, e.middle) <= near_m for e in failed) or any(
        math.dist(frontier.middle, e.middle) <= near_m
        and math.dist(frontier.goal, e.goal) <= near_m
        for e in visited
    )


def _beside(mask: Mask) -> Mask:
    """Return the cells that have a true cell left, right, above or below."""
    found = np.zeros_like(mask)
    found[1:] |= mask[:-1]
    found[:-1] |= mask[1:]
    found[:, 1:] |= mask[:, :-1]
    found[:, :-1] |= mask[:, 1:]
    return found


def _pieces(cells: CellIndices, longest: int) -> list[CellIndices]:
    """Divide a frontier until no piece is longer than ``longest`` cells a side.

    The middle of a long frontier, such as one around a whole room, need not have a view
    of it.
    """
    extent = np.ptp(cells, axis=0)
    axis = int(np.argmax(extent))
    if extent[axis] < longest:
        return [cells]
    middle = (cells[:, axis].min() + cells[:, axis].max()) / 2
    low = cells[:, axis] <= middle
    return [*_pieces(cells[low], longest), *_pieces(cells[~low], longest)]


def _viewpoint(
    piece: CellIndices,
    free: Mask,
    occupied: Mask,
    steps: NDArray[np.int32],
    spec: GridSpec,
    corner: CellIndices,
    params: FrontierParams,
) -> Frontier | None:
    """Return the frontier with the nearest reachable point that sees half of it.

    The distance is along free cells, from the frontier and from its middle. ``corner``
    is the cell of the map that is the first of these arrays.
    """
    reach = round(params.viewpoint_m / spec.resolution)
    low = np.maximum(piece.min(axis=0) - reach, 0)
    high = piece.max(axis=0) + reach + 1
    window = slice(low[0], high[0]), slice(low[1], high[1])
    off = steps_to(piece - low, free[window], reach)
    candidates = np.argwhere((steps[window] < UNREACHED) & (off < UNREACHED))
    off = off[candidates[:, 0], candidates[:, 1]]
    mean = piece.mean(axis=0)
    middle = piece[np.argmin(((piece - mean) ** 2).sum(axis=1))]
    aside = np.hypot(*(candidates + low - middle).T)
    candidates = candidates[np.argsort(off + aside, kind="stable")]
    best = first_that_sees(
        candidates, piece - low, occupied[window], (len(piece) + 1) // 2
    )
    if best < 0:
        return None
    row, column = candidates[best] + low
    goal, centre = spec.centers_of(np.array([(row, column), middle]) + corner).tolist()
    return Frontier(
        goal=tuple(goal),
        middle=tuple(centre),
        length_m=len(piece) * spec.resolution,
        way_m=float(steps[row, column]) * spec.resolution,
    )
