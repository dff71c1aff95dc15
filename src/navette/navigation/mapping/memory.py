"""The map: all costmaps so far, fused."""

import math
from copy import copy
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Footprint, Pose2
from navette.navigation.grids import (
    FREE,
    LETHAL,
    NO_CELLS,
    UNKNOWN,
    CellWindow,
    GridSpec,
    GrowthMemory,
    MapComparison,
    MarkedCells,
    RowSpans,
    SparseGrid,
    SquareRegion,
    accumulate,
    cells_in_footprint,
    mark_points,
    merge,
)
from navette.navigation.mapping.extent import grow_to_hold, known_corners
from navette.navigation.mapping.marked_points import MarkedPoints
from navette.navigation.mapping.methods import MAPPINGS
from navette.navigation.mapping.own_mapping import own_mapping
from navette.navigation.mapping.params import MapMemoryParams
from navette.navigation.mapping.scan_beams import ScanBeams
from navette.navigation.mapping.vanished import VanishedCells

# So far beyond the body, obstacles that the sensors do not see can be touched: in a
# turn, or by a robot that backs up along its way, as recoveries do.
_BESIDE_M = 1.0


class BodyMotion(NamedTuple):
    """Motion of the robot at the stamp of a costmap."""

    yaw_rate: float = 0.0
    """rad/s"""
    vertical_speed: float = 0.0
    """m/s"""
    tilt: float = 0.0
    """angle between the body's z axis and the map's, rad"""


STEADY = BodyMotion()


@dataclass(frozen=True, eq=False)
class PlacedCostmap:
    """A costmap with the robot's pose at its stamp."""

    cells: NDArray[np.int8]
    """(h, w) -1 unknown, 0 free … 100 lethal"""
    spec: GridSpec
    """its geometry in the map frame"""
    sensor: tuple[float, float]
    """(x, y) of the sensor in the map frame, m"""
    map_T_base: Pose2
    """at ``stamp_ns``"""
    stamp_ns: int
    motion: BodyMotion = STEADY
    hits: NDArray[np.float64] | None = None
    """(N, 2) map frame, m: where beams ended, more exact than the lethal cells"""


@MAPPINGS.register("log_odds")
@MAPPINGS.register("max")
@MAPPINGS.register("overwrite")
class MapMemory:
    """Fuse placed costmaps into a map that grows as needed.

    ``overwrite`` and ``max`` store occupancy; ``log_odds`` stores evidence (NaN =
    unknown) and computes the occupancy from it.
    """

    Params = MapMemoryParams

    def __init__(self, params: MapMemoryParams) -> None:
        self._loaded: tuple[NDArray[np.int8], GridSpec] | None = None
        self.configure(params)
        self.reset()

    def configure(self, params: MapMemoryParams) -> None:
        """Replace the parameters; :meth:`MapMemoryParams.shape` must not change.

        A map that is larger than a smaller ``max_size_m`` keeps its size.
        """
        self.params = params
        self._own = own_mapping(params)
        self.footprint = (
            Footprint.from_flat(params.footprint_m) if params.footprint_m else None
        )

    def reset(self) -> None:
        """Clear the map: the loaded map, else unknown cells of the initial extent."""
        # Row and column of the loaded map's first cell, once the map has grown.
        self._loaded_at = 0, 0
        if self._loaded is not None:
            cells, self.spec = self._loaded
            self._cells = cells.copy()
        else:
            self.spec = self._initial_spec()
            self._cells = np.full(self.spec.shape, UNKNOWN, np.int8)
        self._masks = SparseGrid(self.spec.shape, np.uint64)
        self._vanished = VanishedCells(self.spec.shape)
        self._written = RowSpans(self.spec.height)  # of the two above
        self._marked = MarkedPoints()
        self._changed: CellWindow | None = None
        self._cells_memory, self._log_odds_memory = GrowthMemory(), GrowthMemory()
        self._log_odds: NDArray[np.float32] | None = None
        if self.params.fusion == "log_odds":
            self._log_odds = self._evidence_of(self._cells)

    def emptied(self) -> "MapMemory":
        """Return another memory as this one is after :meth:`reset`."""
        other = copy(self)
        other._own = own_mapping(self.params)
        other.reset()
        return other

    def load(self, cells: NDArray[np.int8], spec: GridSpec) -> None:
        """Replace the map by (H, W) and its geometry, also for :meth:`reset`.

        Do not write to ``cells`` afterwards: they are not copied.
        """
        self._loaded = cells, spec
        self.reset()

    def clear(self, region: SquareRegion | None = None) -> None:
        """Restore the loaded map, or unknown cells, in a region or everywhere."""
        if region is None:
            self.reset()
            return
        cleared = region.mask(self.spec)
        self._cells[cleared] = UNKNOWN
        if self._loaded is not None:
            (row, column), (cells, _) = self._loaded_at, self._loaded
            there = np.s_[row : row + cells.shape[0], column : column + cells.shape[1]]
            np.copyto(self._cells[there], cells, where=cleared[there])
        self._masks.cells[cleared] = 0
        if self._log_odds is not None:
            self._log_odds[cleared] = self._evidence_of(self._cells[cleared])
        self._note_change(CellWindow.whole(self.spec.shape))

    def points_in_blind_spot(self, costmap: PlacedCostmap) -> NDArray[np.float64]:
        """Return where beams ended (N, 2), m, beside the body, in cells not seen now.

        The sensors do not show again what stands there until the robot has moved.
        """
        points = self.hit_points()
        if self.footprint is None or not len(points):
            return points[:0]
        base = costmap.map_T_base
        away = np.hypot(points[:, 0] - base.x, points[:, 1] - base.y)
        points = points[away <= self.footprint.circumscribed_radius + _BESIDE_M]
        uv = costmap.spec.origin.inverse().apply(points) / costmap.spec.resolution
        cells = np.floor(uv[:, ::-1]).astype(np.int64)
        inside = ((cells >= 0) & (cells < costmap.spec.shape)).all(axis=1)
        seen = np.zeros(len(points), np.bool_)
        seen[inside] = costmap.cells[tuple(cells[inside].T)] != UNKNOWN
        return points[~seen]

    def restore(self, points: NDArray[np.float64]) -> None:
        """Mark points (N, 2), map, m, within the map as obstacles again."""
        if not len(points):
            return
        window = CellWindow.around(self.spec, points, 1)
        self._written.add(window)
        cells = mark_points(self._masks.cells, self.spec, points)
        rows, columns = cells.T
        self._cells[rows, columns] = LETHAL
        if self._log_odds is not None:
            evidence = self._evidence_of(self._cells[rows, columns])
            self._log_odds[rows, columns] = evidence
        self._note_change(window)

    def fuse(self, costmap: PlacedCostmap) -> bool:
        """Fuse a costmap; return False, without effect, if it has no known cell."""
        corners = known_corners(costmap.cells, costmap.spec)
        if corners is None:
            return False
        self._grow(corners)
        window = self._window_of(costmap)
        self._written.add(window)
        kept = self._kept(costmap, window)
        lethal_cells = self._mark(costmap.hits)
        if self._own is not None:
            self._cells = self._own.update(
                self._cells, self.spec, costmap.cells, costmap.spec
            )
            window = CellWindow.whole(self.spec.shape)
        elif self._log_odds is not None:
            self._add_evidence(self._log_odds, costmap, lethal_cells)
        else:
            merge(
                self._cells,
                self.spec,
                costmap.cells,
                costmap.spec,
                "max" if self.params.fusion == "max" else "overwrite",
                sensor=costmap.sensor,
                erase_within_m=self.params.erase_range_m,
                lethal_cells=lethal_cells,
            )
            self._cells[kept[:, 0], kept[:, 1]] = LETHAL
        if self.footprint is not None:
            self._free_under(self.footprint, costmap.map_T_base)
        if self._log_odds is not None:
            evidence = self._log_odds[window.slices]
            self._cells[window.slices] = self._occupancy_of(evidence)
        self._note_change(window)
        return True

    def take_change(self) -> CellWindow | None:
        """Return the cells that may have changed since the last call.

        None: the extent has changed, or the map was replaced.
        """
        changed, self._changed = self._changed, NO_CELLS
        return changed

    def _note_change(self, window: CellWindow) -> None:
        if self._changed is not None:
            self._changed = self._changed.union(window)
        self._marked.drop(window)

    def _window_of(self, costmap: PlacedCostmap) -> CellWindow:
        """Return the cells that fusing a costmap may change."""
        spec, base = costmap.spec, costmap.map_T_base
        width, height = spec.width * spec.resolution, spec.height * spec.resolution
        corners = np.array([(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)])
        reach = 0.0 if self.footprint is None else self.footprint.circumscribed_radius
        body = [(base.x + s * reach, base.y + s * reach) for s in (-1.0, 1.0)]
        points = [spec.origin.apply(corners), np.array([*body, costmap.sensor])]
        if costmap.hits is not None:
            # Beams that end outside a costmap of the user's own pass cells there.
            points.append(costmap.hits)
        margin = 2 + math.ceil(spec.resolution / self.spec.resolution)
        return CellWindow.around(self.spec, np.concatenate(points), margin)

    @property
    def vanishing(self) -> int:
        """Number of lethal cells that beams of the last costmap passed.

        More costmaps, from other poses, determine whether the obstacles are gone.
        """
        return self._vanished.pending

    @property
    def cells(self) -> NDArray[np.int8]:
        """The map (H, W) itself: valid until the next change, and not to be changed."""
        return self._cells

    def occupancy(self) -> NDArray[np.int8]:
        """Return a copy (H, W) of the map: -1 unknown, 0 free … 100 lethal."""
        return self._cells.copy()

    def hit_points(self) -> NDArray[np.float64]:
        """Return where beams ended (N, 2), map frame, m, within the lethal cells.

        A lethal cell without such a point was lethal in a loaded map, or in a costmap
        without points.
        """
        return self._update_marked().points

    def compared(self, costmap: PlacedCostmap) -> MapComparison:
        """Return the comparison of a costmap with the map near the robot."""
        return MapComparison(
            self._cells,
            self.spec,
            costmap.cells,
            costmap.spec,
            costmap.sensor,
            self.params.change_range_m,
        )

    def warm_up(self) -> None:
        """Load or compile the kernels before the first costmap."""
        if self._own is not None:
            return  # the user's method is called with costmaps only
        edge = self.params.resolution_m
        trial = MapMemory(replace(self.params, size_m=2 * edge, growth_m=10 * edge))
        cells = np.full((2, 3), LETHAL, np.int8)  # wider than the map, which grows
        here = trial.spec.origin
        spec = GridSpec(edge, 3, 2, here)
        hits = here.apply(np.array([(0.5, 0.5), (1.5, 0.5)]) * edge)
        costmap = PlacedCostmap(cells, spec, (here.x, here.y), here, 0, hits=hits)
        trial.fuse(costmap)
        trial.fuse(costmap)  # which finds marked cells
        trial.compared(costmap).count_appeared()

    def _initial_spec(self) -> GridSpec:
        params = self.params
        edge = max(1, round(params.size_m / params.resolution_m))
        corner = edge * params.resolution_m / 2
        origin = Pose2(params.center_x_m - corner, params.center_y_m - corner, 0.0)
        return GridSpec(params.resolution_m, edge, edge, origin)

    def _evidence_of(self, cells: NDArray[np.int8]) -> NDArray[np.float32]:
        """Return the log-odds of occupancies; NaN for unknown cells."""
        limit = self.params.belief_limit
        belief = np.clip(cells / LETHAL, 1.0 - limit, limit)
        evidence = np.log(belief / (1.0 - belief)).astype(np.float32)
        evidence[cells == UNKNOWN] = np.nan
        return evidence

    def _grow(self, corners: NDArray[np.float64]) -> None:
        growth = grow_to_hold(self.spec, corners, self.params)
        if growth is None:
            return
        pad = (growth.rows, growth.columns)
        self._changed = None
        self._marked.grow(growth.rows[0], growth.columns[0])
        self.spec = growth.spec
        self._cells = self._cells_memory.padded(self._cells, pad, UNKNOWN)
        row, column = self._loaded_at
        self._loaded_at = row + pad[0][0], column + pad[1][0]
        self._masks.grow(pad, self._written)
        self._vanished.grow(pad, self._written)
        self._written.grow(pad)
        if self._log_odds is not None:
            self._log_odds = self._log_odds_memory.padded(self._log_odds, pad, np.nan)

    def _kept(self, costmap: PlacedCostmap, window: CellWindow) -> NDArray[np.int64]:
        """Free the lethal cells whose obstacles vanished.

        Return those (N, 2) that ``overwrite`` keeps without an echo.
        """
        if costmap.hits is None or self.params.fusion != "overwrite":
            return np.empty((0, 2), np.int64)
        beams = ScanBeams.of(costmap.hits, costmap.sensor, costmap.cells, costmap.spec)
        gone, kept = self._vanished.update(
            self._update_marked(), window, beams, self.spec.resolution
        )
        self._cells[gone[:, 0], gone[:, 1]] = FREE
        self._masks.cells[gone[:, 0], gone[:, 1]] = 0
        return kept

    def _update_marked(self) -> MarkedCells:
        return self._marked.update(self._masks.cells, self.spec, self._cells)

    def _mark(self, hits: NDArray[np.float64] | None) -> NDArray[np.int64] | None:
        """Store where beams ended; return the cells (M, 2) with these points."""
        if hits is not None:
            return mark_points(self._masks.cells, self.spec, hits)
        # Lethal cells of this costmap have no points, and older ones may mislead.
        self._masks.clear()
        self._marked.clear()
        return None

    def _add_evidence(
        self,
        log_odds: NDArray[np.float32],
        costmap: PlacedCostmap,
        lethal_cells: NDArray[np.int64] | None,
    ) -> None:
        accumulate(
            log_odds,
            self.spec,
            costmap.cells,
            costmap.spec,
            hit=_log_odds(self.params.hit_probability),
            miss=_log_odds(self.params.miss_probability),
            limit=_log_odds(self.params.belief_limit),
            lethal_cells=lethal_cells,
        )

    def _occupancy_of(self, log_odds: NDArray[np.float32]) -> NDArray[np.int8]:
        """Return 100 from the threshold on, 0 up to one miss's belief, else percent."""
        known = ~np.isnan(log_odds)
        belief = 1.0 / (1.0 + np.exp(-log_odds[known]))
        percent = np.minimum(np.rint(100 * belief), LETHAL - 1)
        percent[belief >= self.params.occupied_threshold - 1e-6] = LETHAL
        percent[belief <= self.params.miss_probability + 1e-6] = FREE
        cells = np.full(log_odds.shape, UNKNOWN, np.int8)
        cells[known] = percent
        return cells

    def _free_under(self, footprint: Footprint, map_T_base: Pose2) -> None:
        """Mark the cells under the robot free: the body occupies them."""
        # Wholly under the body: a wall that the body nearly touches keeps its cells.
        inside = cells_in_footprint(
            footprint,
            map_T_base,
            self.spec,
            depth_m=self.spec.resolution * math.sqrt(0.5),
        )
        rows, columns = inside[:, 0], inside[:, 1]
        if self._log_odds is not None:
            miss = np.float32(_log_odds(self.params.miss_probability))
            there = self._log_odds[rows, columns]
            self._log_odds[rows, columns] = np.fmin(there, miss)
            return
        there_now = self._cells[rows, columns]
        clear = (there_now == UNKNOWN) | (there_now == LETHAL)
        self._cells[rows[clear], columns[clear]] = FREE


def _log_odds(probability: float) -> float:
    return math.log(probability / (1.0 - probability))
