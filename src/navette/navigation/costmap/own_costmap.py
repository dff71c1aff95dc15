"""Costmaps of the user: what they get, and the checks of what they return."""

from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from navette.navigation.costmap.methods import COSTMAPS
from navette.navigation.costmap.params import CostmapParams
from navette.navigation.costmap.scan_costmap import (
    ScanCostmap,
    mark_lethal,
    sensor_grid,
)
from navette.navigation.grids import (
    GridSpec,
    PlanarScan,
    beam_directions,
    checked_cells,
)
from navette.params.plugins import own_call


class ScanArrays(NamedTuple):
    """A laser scan as arrays; the sensor's frame, x forward."""

    ranges: NDArray[np.float64]
    """(N,) m; infinite where nothing is within the range, NaN where invalid"""
    angles: NDArray[np.float64]
    """(N,) rad, counter-clockwise from x"""
    points: NDArray[np.float64]
    """(M, 2) x, y of the hits, m"""
    range_max: float
    """m"""

    @classmethod
    def of(cls, scan: PlanarScan) -> "ScanArrays":
        ranges = scan.ranges.astype(np.float64)
        count = len(ranges)
        directions = beam_directions(scan.angle_min, scan.angle_increment, count)
        hit = (ranges > scan.range_min) & (ranges < scan.range_max)
        return cls(
            np.where(hit | (ranges >= scan.range_max), ranges, np.nan),
            scan.angle_min + scan.angle_increment * np.arange(count, dtype=np.float64),
            directions[hit] * ranges[hit, None],
            scan.range_max,
        )


class CostmapMethod(Protocol):
    """A costmap as a function of arrays."""

    def costmap(self, scan: ScanArrays, grid: GridSpec) -> Any:
        """Return costs (H, W): −1 unknown, 0 free … 100 obstacle.

        ``grid`` is centred on the sensor: ``grid.shape``, ``grid.resolution``,
        ``grid.cell_of(x, y)``, ``grid.centers_of(cells)``.
        """


class OwnCostmap:
    """Costmaps of a user's method; its faults raise MethodFaultError."""

    def __init__(self, params: CostmapParams, method: CostmapMethod, name: str) -> None:
        self.params = params
        self.spec = sensor_grid(params)
        self._method = method
        self._name = f"costmap {name}: costmap(scan, grid)"

    def build(
        self, scan: PlanarScan, obstacles: NDArray[np.float64] | None = None
    ) -> NDArray[np.int8]:
        """Return the costmap (H, W) of one scan: -1 unknown, 0 free … 100 hit.

        ``obstacles`` (N, 2), m, of other sensors are lethal, whatever the method
        returned.

        Raises:
            MethodFaultError: the method raised, or returned something else.
        """
        arrays = ScanArrays.of(scan)
        returned = own_call(self._name, self._method.costmap, arrays, self.spec)
        cells = checked_cells(self._name, returned, self.spec.shape)
        if obstacles is not None:
            mark_lethal(cells, self.spec, obstacles)
        return cells

    def hits(self, scan: PlanarScan) -> None:
        """Return None: the obstacles are the cells that the method returns."""

    def warm_up(self) -> None:
        """Do nothing: the user's method is called with scans only."""


def make_costmap(params: CostmapParams) -> ScanCostmap | OwnCostmap:
    """Return the costmap of ``params.method``."""
    method = COSTMAPS.load(params.method)
    made = method.make(params)
    if method.entry == "costmap":
        return OwnCostmap(params, made, method.name)
    built: ScanCostmap = made
    return built
