"""The beams of a scan in the map: where one ended, and what it passed."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids import FREE, LETHAL, GridSpec, grid_frame
from navette.navigation.grids.spec import Cells, GridFrame

Points = NDArray[np.float64]
Values = NDArray[np.float64]

RADIUS_M = 0.02
"""R: the thinnest post that is kept at any distance."""
_POINT_ERROR_M = 0.005
"""Error of the points, besides that of the eighth of a cell that they are stored in."""
_BEAM_ERROR_M, _BEAM_ERROR_RAD = 0.004, 0.0007
"""Errors of a beam: the sensor's position while the body pitches, and the direction."""
_BEYOND_M = 0.1
"""Least distance beyond the points at which a beam ends, against noise."""
_SAME_M = 0.1
"""An echo within this distance of the points may be one of the same obstacle."""

_CHAINS = 2048
"""Number of chains of echoes, a power of two."""

ALL_DIRECTIONS = 0xFFFFFFFF
"""Directions of a circle, one per bit."""
_SECTOR = math.pi / 16


class ScanBeams(NamedTuple):
    """A scan and its costmap in the map, for kernels.

    Attributes:
        angles: (N,) rad, of the beams with an echo, ascending.
        ranges: (N,) m.
        step: between neighbouring beams, rad.
        echoes: (N, 2) where they ended, m.
        first: index of the first echo of each chain, −1: none. Squares are twice as
            wide as _SAME_M; those of one hash have a chain.
        after: (N,) the next echo of the same chain, −1: none.
        sensor: x, y, m.
        cells: (h, w) of the costmap: 0 to 99 where beams crossed it.
        frame: its geometry.
    """

    angles: Values
    ranges: Values
    step: float
    echoes: Points
    first: NDArray[np.int32]
    after: NDArray[np.int32]
    sensor: tuple[float, float]
    cells: Cells
    frame: GridFrame

    @classmethod
    def of(
        cls, hits: Points, sensor: tuple[float, float], cells: Cells, spec: GridSpec
    ) -> "ScanBeams":
        """Args: echoes (N, 2), in the map, m; the sensor there; the costmap."""
        echoes = np.ascontiguousarray(hits)
        first, after = _chains(echoes)
        off = echoes - sensor
        angles = np.arctan2(off[:, 1], off[:, 0])
        order = np.argsort(angles)
        angles, ranges = angles[order], np.hypot(off[:, 0], off[:, 1])[order]
        return cls(
            angles,
            ranges,
            _median_step(angles),
            echoes,
            first,
            after,
            sensor,
            cells,
            grid_frame(spec),
        )


def _median_step(angles: Values) -> float:
    steps = np.diff(angles)
    steps = steps[steps > 1e-5]
    return float(np.median(steps)) if steps.size else np.inf


@kernel
def _chains(echoes: Any) -> Any:
    """Return :class:`ScanBeams`' first and next echo."""
    first = np.full(_CHAINS, -1, np.int32)
    after = np.empty(echoes.shape[0], np.int32)
    for j in range(echoes.shape[0]):
        chain = _chain(echoes[j, 0], echoes[j, 1])
        after[j], first[chain] = first[chain], j
    return first, after


@kernel(allocates=False)
def _chain(x: float, y: float) -> int:
    """Return the chain of the square that contains a point."""
    column, row = math.floor(x / (2 * _SAME_M)), math.floor(y / (2 * _SAME_M))
    return (row * 73856093 ^ column * 19349663) & (_CHAINS - 1)


@kernel(allocates=False)
def has_echo(x: float, y: float, beams: ScanBeams) -> bool:
    """Return whether an echo may be of the obstacle at a point."""
    for side in range(4):  # the squares about the point
        at_x = x - _SAME_M if side % 2 else x + _SAME_M
        at_y = y - _SAME_M if side // 2 else y + _SAME_M
        j = beams.first[_chain(at_x, at_y)]
        while j >= 0:
            dx, dy = beams.echoes[j, 0] - x, beams.echoes[j, 1] - y
            if dx * dx + dy * dy < _SAME_M * _SAME_M:
                return True
            j = beams.after[j]
    return False


@kernel(allocates=False)
def possible_directions(
    x: float, y: float, edge_m: float, beams: ScanBeams
) -> np.uint32:
    """Return in which directions from a point a post may be after a scan.

    Args:
        x, y: middle of the points of a cell, in the map, m.
        edge_m: of the squares that the points are stored as.
        beams: of the scan.
    """
    count = beams.angles.size
    possible = np.uint32(ALL_DIRECTIONS)
    if count < 2:
        return possible
    reach = RADIUS_M + _POINT_ERROR_M + edge_m * math.sqrt(0.5)
    dx, dy = x - beams.sensor[0], y - beams.sensor[1]
    bearing, away = math.atan2(dy, dx), np.hypot(dx, dy)
    after = _first_from(beams.angles, bearing)
    for side in range(2):
        beside = (after - side) % count
        off = _wrapped(bearing - beams.angles[beside])
        if abs(off) > 1.5 * beams.step:
            # Beams without an echo are where a scanner with even steps has them:
            # those beside the point are the next of this row.
            off = off % beams.step - (beams.step if side == 0 else 0.0)
            passes = _is_crossed(x, y, away, beams)
        else:
            passes = beams.ranges[beside] >= away + _BEYOND_M
        if passes and abs(off) < 0.5 * math.pi:
            possible &= _left(bearing, off, away, reach)
    return possible


@kernel(allocates=False)
def _first_from(angles: Values, least: float) -> int:
    """Return ``np.searchsorted(angles, least)``.

    With that in a kernel Numba imports SciPy's linear algebra: 0.2 s and 16 MB.
    """
    first, last = 0, angles.size
    while first < last:
        middle = (first + last) // 2
        if angles[middle] < least:
            first = middle + 1
        else:
            last = middle
    return first


@kernel(allocates=False)
def _left(bearing: float, off: float, away: float, reach: float) -> np.uint32:
    """Return the directions that a beam at an angle ``off`` to a point leaves."""
    aside = away * abs(math.sin(off)) + (_BEAM_ERROR_M + _BEAM_ERROR_RAD * away)
    if aside >= RADIUS_M:
        return np.uint32(ALL_DIRECTIONS)
    # The centre is away from the beam: on the side on which the point is.
    normal = bearing - off + math.copysign(0.5 * math.pi, off)
    half = math.acos((RADIUS_M - aside) / reach) + 0.5 * _SECTOR
    left = np.uint32(0)
    for k in range(32):
        if abs(_wrapped(k * _SECTOR - normal)) <= half:
            left |= np.uint32(1) << np.uint32(k)
    return left


@kernel(allocates=False)
def _wrapped(angle: float) -> float:
    """Return the same angle in [−π, π)."""
    wrapped: float = (angle + math.pi) % (2.0 * math.pi) - math.pi
    return wrapped


@kernel(allocates=False)
def _is_crossed(x: float, y: float, away: float, beams: ScanBeams) -> bool:
    """Return whether beams crossed the cells of a point and behind it.

    Otherwise one without an echo proves nothing. Behind is away from the sensor, where
    a beam ends: at the end of a scanner's range, an obstacle that is a little further
    has no echo.
    """
    share = _BEYOND_M / max(away, 1e-6)
    dx, dy = x - beams.sensor[0], y - beams.sensor[1]
    return bool(
        _is_free(x, y, beams) and _is_free(x + dx * share, y + dy * share, beams)
    )


@kernel(allocates=False)
def _is_free(x: float, y: float, beams: ScanBeams) -> bool:
    cells, frame = beams.cells, beams.frame
    dx, dy = x - frame.x, y - frame.y
    column = math.floor((frame.cos * dx + frame.sin * dy) / frame.resolution)
    row = math.floor((frame.cos * dy - frame.sin * dx) / frame.resolution)
    if not (0 <= row < cells.shape[0] and 0 <= column < cells.shape[1]):
        return False
    return bool(FREE <= cells[row, column] < LETHAL)
