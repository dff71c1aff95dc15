"""Frontiers of a map: where known free space meets unknown space.

A frontier is a connected set of free cells beside unknown ones (Yamauchi, "A
frontier-based approach for autonomous exploration", CIRA 1997). The robot drives to the
frontier whose length, as a measure of what may be seen there, is worth the distance
(Burgard et al., "Coordinated multi-robot exploration", IEEE T-RO 2005, eq. 4 with one
robot).
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from navette.navigation.grids import CellWindow, GridSpec
from navette.navigation.grids.spec import Cells
from navette.navigation.missions.explore.cell_kinds import (
    OPEN,
    PLACE,
    CellIndices,
    CellKinds,
    KindDistances,
)
from navette.navigation.missions.explore.waves import (
    UNREACHED,
    Reached,
    connected_sets,
    first_that_sees,
    steps_from,
    steps_to,
)

_WALL_M = 0.1
"""Cells as near to an obstacle belong to it: thickness and noise of walls."""
_FIRST_STEPS = 400  # each further search goes twice as far


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
        best: the frontier to drive to; None if none can be reached.
        count: number of frontiers, including unreachable ones.
        free_m2: known free area.
        known_m2: known area.
        open_share: share of the free space's boundary that is frontier.
    """

    best: Frontier | None
    count: int
    free_m2: float
    known_m2: float
    open_share: float


class FrontierSearch:
    """The frontiers of a map that is explored.

    The work of an update grows with the part that changed, that of a search with the
    distance to the frontier that it finds.
    """

    def __init__(self, spec: GridSpec, params: FrontierParams) -> None:
        self._map = CellKinds(spec, _distances(params), params.lethal_cost)
        self._spec, self._params = spec, params

    @classmethod
    def of(
        cls, cells: Cells, spec: GridSpec, params: FrontierParams
    ) -> "FrontierSearch":
        """Return the search of a whole map.

        Args:
            cells: (H, W) occupancy, -1 unknown, 0 free to 100 occupied.
            spec: geometry of the grid.
            params: values of the choice.
        """
        search = cls(spec, params)
        known = CellWindow.of_known(cells)
        search.update(cells[known.slices], known)
        return search

    def update(self, cells: Cells, window: CellWindow) -> None:
        """Replace the cells (h, w) of a window of the map."""
        if not window.is_empty:
            self._map.update(cells, window)

    def set_params(self, params: FrontierParams) -> None:
        """Use other values; ``lethal_cost`` is that of the beginning."""
        if _distances(params) != _distances(self._params):
            self._map.set_distances(_distances(params))
        self._params = params

    def explore(
        self,
        robot: tuple[float, float],
        *,
        failed: Sequence[Frontier] = (),
        visited: Sequence[Frontier] = (),
        first_steps: int = _FIRST_STEPS,
    ) -> Exploration:
        """Return the best frontier and the explored area.

        Args:
            robot: position of the robot, m, map.
            failed: frontiers that were not reached; those near to them are left out.
            visited: frontiers that were still there when their goal was reached. Those
                near to them are left out unless they are seen from another place.
            first_steps: cells that the search goes at first; the result is the same.
        """
        resolution = self._spec.resolution
        cells = self._map.cells_of(OPEN, self._map.known)
        least = math.ceil(self._params.min_length_m / resolution - 1e-9)
        sets = connected_sets(cells, max(least, 1))
        longest = max(1, round(self._params.max_length_m / resolution))
        pieces = [piece for cluster in sets for piece in _pieces(cluster, longest)]
        open_cells = sum(map(len, pieces))
        total = open_cells + self._map.closed
        free, occupied = self._map.free, self._map.occupied
        return Exploration(
            best=self._best(pieces, robot, first_steps, failed, visited),
            count=len(pieces),
            free_m2=free * resolution**2,
            known_m2=(free + occupied) * resolution**2,
            open_share=open_cells / total if total else 0.0,
        )

    def is_open(self, frontier: Frontier) -> bool:
        """Return whether a good part of a frontier is left near to its middle."""
        resolution, least_m = self._spec.resolution, self._params.min_length_m
        row, column = self._spec.cell_of(*frontier.middle)
        reach = round(max(least_m, frontier.length_m / 4) / resolution) + 1
        near = CellWindow(row, row + 1, column, column + 1)
        near = near.grown(reach, self._map.kinds.shape)
        left_m = len(self._map.cells_of(OPEN, near)) * resolution
        return left_m >= min(least_m, frontier.length_m) / 2

    def _best(
        self,
        pieces: Sequence[CellIndices],
        robot: tuple[float, float],
        limit: int,
        failed: Sequence[Frontier],
        visited: Sequence[Frontier],
    ) -> Frontier | None:
        """Return the best frontier that can be reached, searching further and further.

        It is the best of the whole map: frontiers beyond the cells reached have a
        longer path, and none is longer than the longest piece.
        """
        row, column = self._spec.cell_of(*robot)
        resolution, gain = self._spec.resolution, self._params.gain
        most_m = gain * max(map(len, pieces), default=0) * resolution
        # The least possible scores: as if there were no obstacles.
        steps = [self._least_steps(piece, row, column) for piece in pieces]
        least = np.array(steps) - gain * np.array([*map(len, pieces)])
        order = np.argsort(least, kind="stable").tolist()
        while pieces:
            reached = steps_from((row, column), self._map.kinds, limit)
            settled = UNREACHED if reached.is_all else limit - self._detour
            best = None
            for k in order:
                if best is not None and self._score(best) < least[k] * resolution:
                    break
                if steps[k] > settled:
                    continue
                found = self._frontier(pieces[k], reached, settled)
                if found is None or self._is_hopeless(found, failed, visited):
                    continue
                if best is None or self._key(found) < self._key(best):
                    best = found
            if reached.is_all:
                return best
            if best is not None and self._score(best) < settled * resolution - most_m:
                return best
            limit *= 2
        return None

    @property
    def _reach(self) -> int:
        """Largest number of steps between a frontier and its goal."""
        return round(self._params.viewpoint_m / self._spec.resolution)

    @property
    def _detour(self) -> int:
        """Steps by which the path to a goal of a frontier may be the longer one."""
        longest = round(self._params.max_length_m / self._spec.resolution)
        return 2 * (self._reach + longest)

    def _score(self, frontier: Frontier) -> float:
        """Return the path (m) less what the frontier is worth; the least is best."""
        return frontier.way_m - self._params.gain * frontier.length_m

    def _key(self, frontier: Frontier) -> tuple[float, tuple[float, float]]:
        return self._score(frontier), frontier.goal

    def _least_steps(self, piece: CellIndices, row: int, column: int) -> int:
        """Return a lower bound of the steps from a cell to the goal of a piece."""
        apart = np.maximum(piece.min(axis=0) - (row, column), 0)
        apart = np.maximum(apart, (row, column) - piece.max(axis=0))
        return max(int(apart.max()) - self._reach, 0)

    def _frontier(
        self, piece: CellIndices, reached: Reached, settled: int
    ) -> Frontier | None:
        """Return a piece with the nearest point that sees half of it.

        The distance is along free cells, from the frontier and from its middle. Points
        to which the path leads far around an obstacle are not used, so that points
        beyond the cells reached make no difference; None if the first one is more than
        ``settled`` steps from the robot.
        """
        off = steps_to(piece, self._map.kinds, self._reach)
        steps = reached.within(off.window)
        places = (self._map.kinds[off.window.slices] & PLACE) != 0
        is_candidate = places & (steps < UNREACHED) & (off.steps < UNREACHED)
        if not is_candidate.any():
            return None
        first = int(steps[is_candidate].min())
        if first > settled:
            return None
        candidates = np.argwhere(is_candidate & (steps <= first + self._detour))
        away = off.steps[candidates[:, 0], candidates[:, 1]]
        candidates += (off.window.first_row, off.window.first_column)
        mean = piece.mean(axis=0)
        middle = piece[np.argmin(((piece - mean) ** 2).sum(axis=1))]
        aside = np.hypot(*(candidates - middle).T)
        candidates = candidates[np.argsort(away + aside, kind="stable")]
        least = (len(piece) + 1) // 2
        best = first_that_sees(candidates, piece, self._map.kinds, least)
        if best < 0:
            return None
        row, column = candidates[best]
        goal, centre = self._spec.centers_of(np.array([(row, column), middle])).tolist()
        way = steps[row - off.window.first_row, column - off.window.first_column]
        return Frontier(
            goal=tuple(goal),
            middle=tuple(centre),
            length_m=len(piece) * self._spec.resolution,
            way_m=float(way) * self._spec.resolution,
        )

    def _is_hopeless(
        self,
        frontier: Frontier,
        failed: Sequence[Frontier],
        visited: Sequence[Frontier],
    ) -> bool:
        """Whether another drive to the frontier promises nothing."""
        near_m = self._params.viewpoint_m / 4
        return any(
            math.dist(frontier.middle, each.middle) <= near_m for each in failed
        ) or any(
            math.dist(frontier.middle, each.middle) <= near_m
            and math.dist(frontier.goal, each.goal) <= near_m
            for each in visited
        )


def _distances(params: FrontierParams) -> KindDistances:
    passage_m = min(params.passage_m, params.clearance_m)
    return KindDistances(_WALL_M, passage_m, params.clearance_m)


def _pieces(cells: CellIndices, longest: int) -> Iterator[CellIndices]:
    """Divide a frontier until no piece is longer than ``longest`` cells a side.

    The middle of a long frontier, such as one around a whole room, need not have a view
    of it.
    """
    extent = np.ptp(cells, axis=0)
    axis = int(np.argmax(extent))
    if extent[axis] < longest:
        yield cells
        return
    middle = (cells[:, axis].min() + cells[:, axis].max()) / 2
    low = cells[:, axis] <= middle
    yield from _pieces(cells[low], longest)
    yield from _pieces(cells[~low], longest)
