"""Costmap around the sensor from one laser scan."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Pose2
from navette.navigation.costmap.grazing import grazing_margins
from navette.navigation.costmap.methods import COSTMAPS
from navette.navigation.costmap.params import CostmapParams
from navette.navigation.grids import (
    LETHAL,
    UNKNOWN,
    GridSpec,
    PlanarScan,
    beam_directions,
    cost_table,
    inflate,
    trace_beams,
)


def sensor_grid(params: CostmapParams) -> GridSpec:
    """Return the square grid about the sensor, in the sensor's frame.

    Its number of cells is odd: the sensor is at the centre of the middle cell.
    """
    cells = 2 * math.ceil(params.size_m / params.resolution_m / 2 - 0.5 - 1e-9) + 1
    corner = -cells * params.resolution_m / 2
    return GridSpec(params.resolution_m, cells, cells, Pose2(corner, corner, 0.0))


def mark_lethal(
    cells: NDArray[np.int8], spec: GridSpec, points: NDArray[np.float64]
) -> None:
    """Mark the cells of points (N, 2), m, in the frame of a grid about the sensor."""
    corner = np.array([spec.origin.x, spec.origin.y])
    index = np.floor((points - corner) / spec.resolution).astype(np.int64)
    inside = ((index >= 0) & (index < (spec.width, spec.height))).all(axis=1)
    columns, rows = index[inside].T
    cells[rows, columns] = LETHAL


@COSTMAPS.register("scan")
class ScanCostmap:
    """Build costmaps: trace the beams, mark the hits, inflate."""

    Params = CostmapParams

    def __init__(self, params: CostmapParams) -> None:
        self.params = params
        self.spec = sensor_grid(params)
        self._table = cost_table(
            "linear" if params.inflation_method == "linear" else "exponential",
            inflation_radius_m=params.inflation_radius_m,
            resolution=params.resolution_m,
            max_cost=params.max_cost,
            decay_per_m=params.inflation_decay_per_m,
        )
        self._beams: tuple[float, float, int] | None = None
        self._directions = np.empty((0, 2))

    def build(
        self, scan: PlanarScan, obstacles: NDArray[np.float64] | None = None
    ) -> NDArray[np.int8]:
        """Return the costmap (H, W) of one scan: -1 unknown, 0 free … 100 hit.

        ``obstacles`` (N, 2), m, are those of other sensors: lethal, whatever the scan
        measured there.

        Only cells that the scan measured get an inflated cost. An unknown cell beside
        an obstacle stays unknown, so that the map keeps its value there (the far side
        of a box, a post in the shadow of another).
        """
        directions = self._directions_of(scan)
        cost = np.full(self.spec.shape, UNKNOWN, np.int8)
        # The diagonal is the longest beam within the grid.
        reach = min(scan.range_max, 1.5 * self.spec.width * self.spec.resolution)
        if scan.range_min < reach:
            trace_beams(
                cost,
                self.spec,
                (0.0, 0.0),
                directions,
                scan.ranges,
                range_min=scan.range_min,
                range_max=reach,
                margins=self._margins(scan, directions),
                fills=True,
            )
        if obstacles is not None:
            mark_lethal(cost, self.spec, obstacles)
        return inflate(cost, self._table, raise_unknown=False)

    def hits(self, scan: PlanarScan) -> NDArray[np.float64]:
        """Return where the beams of a scan ended (N, 2), m, within the costmap."""
        half = self.spec.width * self.spec.resolution / 2
        points = np.empty((len(scan.ranges), 2))
        count = _end_points(
            scan.ranges,
            self._directions_of(scan),
            np.float32(scan.range_min),
            np.float32(scan.range_max),
            half,
            points,
        )
        return points[:count]

    def warm_up(self) -> None:
        """Load or compile the kernels before the first scan."""
        scan = PlanarScan(np.ones(2, np.float32), 0.0, 0.1, 0.1, 2.0)
        self.build(scan)
        self.hits(scan)
        many_lethal = np.full((1, 1), LETHAL, np.int8)
        inflate(many_lethal, self._table, raise_unknown=False)

    def _margins(
        self, scan: PlanarScan, directions: NDArray[np.float64]
    ) -> NDArray[np.float32]:
        return grazing_margins(
            scan.ranges,
            directions,
            range_min=scan.range_min,
            range_max=scan.range_max,
            clearance=self.params.resolution_m * math.sqrt(0.5),
            most=self.params.grazing_margin_m,
        )

    def _directions_of(self, scan: PlanarScan) -> NDArray[np.float64]:
        """Return the beams' unit vectors, cached because a scanner repeats them."""
        beams = (scan.angle_min, scan.angle_increment, len(scan.ranges))
        if beams != self._beams:
            self._directions, self._beams = beam_directions(*beams), beams
        return self._directions


@kernel(allocates=False)
def _end_points(
    ranges: Any, directions: Any, least: Any, most: Any, half: float, points: Any
) -> int:
    """Write where beams ended within a square; return how many."""
    count = 0
    for i in range(ranges.size):
        if least < ranges[i] < most:
            x, y = directions[i, 0] * ranges[i], directions[i, 1] * ranges[i]
            if abs(x) < half and abs(y) < half:
                points[count, 0], points[count, 1] = x, y
                count += 1
    return count
