"""Occupancy grid of placed scans."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2, angle_difference
from navette.navigation.grids import (
    FREE,
    LETHAL,
    UNKNOWN,
    CellWindow,
    GridSpec,
    PlanarScan,
    accumulate,
    beam_directions,
    trace_beams,
)
from navette.navigation.slam.params import SlamParams

# Log odds of one hit and one miss (probabilities 0.7 and 0.4), and their limit.
_HIT, _MISS, _LIMIT = 0.85, -0.4, 10.0
# From a probability of 0.65 on a cell is lethal, as map_server's occupied_thresh.
_OCCUPIED = 0.62
_MARGIN_CELLS = 2
# Room for a map to grow without being drawn again.
_MARGIN_M = 5.0
# Cells of the largest map, 400 m wide at 5 cm; a larger one gets coarser cells.
_MOST_CELLS = 8_000**2


class MapScan(NamedTuple):
    """A scan and the pose of its sensor in the map."""

    scan: PlanarScan
    map_T_sensor: Pose2


def render(
    scans: Sequence[MapScan], params: SlamParams
) -> tuple[NDArray[np.int8], GridSpec]:
    """Return the map (H, W) of all scans and its geometry.

    Each scan frees the cells that its beams pass and hits those in which they end; the
    evidence of all scans is added as log odds (Moravec and Elfes 1985). −1 is unknown,
    0 free, 100 lethal.
    """
    spec = _extent(scans, params)
    field = np.full(spec.shape, np.nan, np.float32)
    for each in scans:
        add_scan(field, spec, each, params)
    return occupancy_of(field), spec


class MapRenderer:
    """The map of a growing graph: new scans are added, moved ones drawn again."""

    def __init__(self, params: SlamParams) -> None:
        self._params = params
        self._drawn: list[MapScan] = []
        self._spec: GridSpec | None = None
        self._field = np.empty((0, 0), np.float32)

    def render(self, scans: Sequence[MapScan]) -> tuple[NDArray[np.int8], GridSpec]:
        """Return the map of all scans, as :func:`render`, with a margin."""
        known = len(self._drawn)
        if (
            self._spec is None
            or known > len(scans)
            or not _holds(self._spec, _bounds(scans[known:], self._params))
            or _most_moved(self._drawn, scans) > 0.5 * self._params.resolution_m
        ):
            self._spec = _extent(scans, self._params, margin_m=_MARGIN_M)
            self._field = np.full(self._spec.shape, np.nan, np.float32)
            self._drawn = []
        for each in scans[len(self._drawn) :]:
            add_scan(self._field, self._spec, each, self._params)
            self._drawn.append(each)
        return occupancy_of(self._field), self._spec


def _holds(spec: GridSpec, bounds: NDArray[np.float64]) -> bool:
    """Whether bounds (2, 2) in a grid's frame, m, lie within it; empty ones do."""
    edge = spec.resolution
    low = np.array([spec.origin.x, spec.origin.y])
    high = low + np.array([spec.width * edge, spec.height * edge])
    return bool((bounds[0] >= low).all() and (bounds[1] <= high).all())


def _most_moved(drawn: Sequence[MapScan], scans: Sequence[MapScan]) -> float:
    """Return the largest motion of a scan since it was drawn, m; yaw at 5 m."""
    return max(
        (
            one.map_T_sensor.distance_to(other.map_T_sensor)
            + 5.0 * abs(angle_difference(one.map_T_sensor.yaw, other.map_T_sensor.yaw))
            for one, other in zip(drawn, scans, strict=False)
        ),
        default=0.0,
    )


def add_scan(
    field: NDArray[np.float32], spec: GridSpec, placed: MapScan, params: SlamParams
) -> None:
    """Add the evidence of one scan to a field (H, W) of log odds, NaN = unknown."""
    scan, sensor = placed
    hits, silent = _readings(scan, params)
    ends = _ends(placed, hits, silent, params)
    low, high = _cells_around(spec, ends)
    if (low >= high).any():
        return
    there = CellWindow(*map(int, (low[0], high[0], low[1], high[1])))
    window, part = field[there.slices], there.spec_in(spec)
    if not part.contains(*part.cell_of(sensor.x, sensor.y)):
        return
    cells = np.full(part.shape, UNKNOWN, np.int8)
    directions = beam_directions(
        scan.angle_min + sensor.yaw, scan.angle_increment, len(scan.ranges)
    )
    where = (sensor.x, sensor.y)
    # Beams without an echo first: they never free what another beam hits.
    for ranges, reach in ((silent, params.free_range_m), (hits, params.max_range_m)):
        trace_beams(
            cells, part, where, directions, ranges,
            range_min=scan.range_min, range_max=max(reach, 1.01 * scan.range_min),
            fills=True,
        )  # fmt: skip
    evidence = np.ascontiguousarray(window)
    accumulate(evidence, part, cells, part, hit=_HIT, miss=_MISS, limit=_LIMIT)
    window[:] = evidence


def occupancy_of(field: NDArray[np.float32]) -> NDArray[np.int8]:
    """Return −1 unknown, 0 free or 100 lethal for log odds (H, W), NaN = unknown."""
    cells = np.where(field >= _OCCUPIED, LETHAL, FREE).astype(np.int8)
    cells[np.isnan(field)] = UNKNOWN
    return cells


def _readings(
    scan: PlanarScan, params: SlamParams
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return the ranges of beams with an echo, and of those without; others NaN."""
    ranges = np.asarray(scan.ranges, np.float32)
    echo = (ranges > scan.range_min) & (
        ranges < min(scan.range_max, params.max_range_m)
    )
    far = (ranges >= scan.range_max) | (echo & (ranges >= params.max_range_m))
    nothing = np.float32(np.nan)
    return (
        np.where(echo, ranges, nothing).astype(np.float32),
        np.where(far, np.float32(np.inf), nothing).astype(np.float32),
    )


def _ends(
    placed: MapScan,
    hits: NDArray[np.float32],
    silent: NDArray[np.float32],
    params: SlamParams,
) -> NDArray[np.float64]:
    """Return (N, 2) the ends of all beams and the sensor, in the map, m."""
    scan, sensor = placed
    directions = beam_directions(
        scan.angle_min + sensor.yaw, scan.angle_increment, len(scan.ranges)
    )
    reach = np.where(np.isinf(silent), params.free_range_m, hits)
    used = ~np.isnan(reach)
    here = np.array([[sensor.x, sensor.y]])
    return np.concatenate([here, here + directions[used] * reach[used, None]])


def _cells_around(
    spec: GridSpec, points: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the first and last (exclusive) row and column around points."""
    uv = (points - (spec.origin.x, spec.origin.y)) / spec.resolution
    rows_columns = np.floor(uv[:, ::-1]).astype(np.int64)
    low = np.maximum(rows_columns.min(axis=0), 0)
    return low, np.minimum(rows_columns.max(axis=0) + 1, spec.shape)


def _bounds(scans: Sequence[MapScan], params: SlamParams) -> NDArray[np.float64]:
    """Return the least and the largest x, y (2, 2) of all beams; ±∞ without scans."""
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for each in scans:
        ends = _ends(each, *_readings(each.scan, params), params)
        low = np.minimum(low, ends.min(axis=0))
        high = np.maximum(high, ends.max(axis=0))
    return np.array([low, high])


def _extent(
    scans: Sequence[MapScan], params: SlamParams, *, margin_m: float = 0.0
) -> GridSpec:
    """Return the grid that holds all beams, in whole cells of the map's frame."""
    low, high = _bounds(scans, params) if scans else np.zeros((2, 2))
    low, high = low - margin_m, high + margin_m
    resolution = params.resolution_m
    while np.prod((high - low) / resolution + 2 * _MARGIN_CELLS + 2) > _MOST_CELLS:
        resolution *= 2.0
    first = np.floor(low / resolution) - _MARGIN_CELLS
    width, height = (np.ceil(high / resolution) + _MARGIN_CELLS - first).astype(int)
    origin = Pose2(float(first[0] * resolution), float(first[1] * resolution), 0.0)
    return GridSpec(resolution, int(width), int(height), origin)
