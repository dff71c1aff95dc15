"""Obstacles that beams passed: objects that moved away, also at a distance.

At a distance, neighbouring beams pass a thin post on both sides and mark its cell free
without having measured it, so a free cell there proves nothing. A cell keeps where
beams ended in it. These points are those of an obstacle, at least of a post of the
radius R, whose centre is at most R from their middle. A beam that passes the middle at
a distance s < R, and ends beyond, leaves only the directions away from it: a centre at
an angle of at most ``acos((R - s) / R)`` to the beam's normal. Beams that passed on
several sides, in scans from any place, leave no direction: the obstacle is gone.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids import RowSpans, SparseGrid

Points = NDArray[np.float64]
Values = NDArray[np.float64]
Flags = NDArray[np.bool_]
Bits = NDArray[np.uint32]
"""Directions of a circle, one per bit."""

_RADIUS_M = 0.02
"""R: the thinnest post that is kept at any distance."""
_POINT_ERROR_M = 0.005
"""Error of the points, besides that of the eighth of a cell that they are stored in."""
_BEAM_ERROR_M, _BEAM_ERROR_RAD = 0.004, 0.0007
"""Errors of a beam: the sensor's position while the body pitches, and the direction."""
_BEYOND_M = 0.1
"""Least distance beyond the points at which a beam ends, against noise."""
_SAME_M = 0.1
"""An echo within this distance of the points may be one of the same obstacle."""
_TIMES = 3
"""Least number of scans that passed before a cell is free, against faulty scans."""

_ALL = np.uint32(0xFFFFFFFF)
_ANGLES = np.arange(32) * (math.pi / 16)
_HALF_SECTOR = math.pi / 32
_BIT_VALUES = np.uint32(1) << np.arange(32, dtype=np.uint32)


class VanishedCells:
    """Where, seen from each cell's points, no obstacle was found to be since its echo.

    ``shape`` is that of the map.
    """

    def __init__(self, shape: tuple[int, int]) -> None:
        self._passes = SparseGrid(shape, np.uint8)
        self._refuted = SparseGrid(shape, np.uint32)
        self.pending = 0
        """Number of cells that beams of the last scan passed, and that are not free."""

    def grow(
        self, pad: tuple[tuple[int, int], tuple[int, int]], written: RowSpans
    ) -> None:
        """Add cells around, as :func:`numpy.pad` does."""
        self._passes.grow(pad, written)
        self._refuted.grow(pad, written)

    def forget(self, cells: NDArray[np.int64]) -> None:
        """Start again for cells (N, 2) with an echo."""
        rows, columns = cells.T
        self._passes.cells[rows, columns] = 0
        self._refuted.cells[rows, columns] = 0

    def update(self, cells: NDArray[np.int64], possible: Bits) -> NDArray[np.int64]:
        """Return the cells (K, 2) whose obstacles are gone.

        Args:
            cells: (N, 2) lethal cells without an echo, each once.
            possible: (N,) directions to an obstacle that this scan left, of
                :func:`possible_directions`.
        """
        passed = possible != _ALL
        rows, columns = cells[passed].T
        refuted = self._refuted.cells[rows, columns] | ~possible[passed]
        self._refuted.cells[rows, columns] = refuted
        passes = np.minimum(self._passes.cells[rows, columns], 254) + 1
        self._passes.cells[rows, columns] = passes
        gone = (passes >= _TIMES) & (refuted == _ALL)
        self.pending = int(np.count_nonzero(~gone))
        vanished: NDArray[np.int64] = np.column_stack([rows[gone], columns[gone]])
        self.forget(vanished)
        return vanished


def middles(points: Points, which: NDArray[np.int64], count: int) -> Points:
    """Return the mean (count, 2) of the points (N, 2) with each index of ``which``."""
    number = np.maximum(np.bincount(which, minlength=count), 1)
    return np.column_stack(
        [np.bincount(which, axis, count) / number for axis in points.T]
    )


def behind(points: Points, sensor: tuple[float, float]) -> Points:
    """Return the points (M, 2) moved away from the sensor, to where a beam ends.

    At the end of a scanner's range, an obstacle that is a little further has no echo.
    """
    off = points - sensor
    away = np.maximum(np.hypot(*off.T), 1e-6)
    return np.asarray(points + off * (_BEYOND_M / away)[:, None])


def have_echo(points: Points, hits: Points) -> Flags:
    """Return (M,) whether an echo may be of the obstacle at each point."""
    found: Flags = _are_near(points, hits[np.argsort(hits[:, 0])], _SAME_M)
    return found


@kernel
def _are_near(points: Any, others: Any, reach: float) -> Any:
    """Return (M,) whether one of the others (N, 2), sorted by x, is within reach."""
    near = np.zeros(points.shape[0], np.bool_)
    for i in range(points.shape[0]):
        x, y = points[i, 0], points[i, 1]
        first, end = 0, others.shape[0]
        while first < end:
            middle = (first + end) // 2
            if others[middle, 0] < x - reach:
                first = middle + 1
            else:
                end = middle
        for j in range(first, others.shape[0]):
            dx, dy = others[j, 0] - x, others[j, 1] - y
            if dx > reach:
                break
            if dx * dx + dy * dy < reach * reach:
                near[i] = True
                break
    return near


class Beams(NamedTuple):
    """The beams before and after each of M points, by their angle at the sensor.

    Attributes:
        off: (2, M) rad from the beam to the point.
        away: (M,) m from the sensor to the point.
        bearing: (M,) rad, of the point.
        beyond: (2, M) whether the beam ended beyond the point.
        silent: (2, M) whether the beam had no echo.
    """

    off: Values
    away: Values
    bearing: Values
    beyond: Flags
    silent: Flags

    @classmethod
    def of(cls, points: Points, hits: Points, sensor: tuple[float, float]) -> "Beams":
        """Args: points (M, 2) and at least two echoes (N, 2), in the map, m; sensor.

        Beams without an echo are where a scanner with even steps has them.
        """
        beams, there = hits - sensor, points - sensor
        angles = np.arctan2(beams[:, 1], beams[:, 0])
        order = np.argsort(angles)
        angles, ranges = angles[order], np.hypot(*beams[order].T)
        bearing, away = np.arctan2(there[:, 1], there[:, 0]), np.hypot(*there.T)
        after = np.searchsorted(angles, bearing)
        beside = np.stack([after, after - 1]) % len(angles)
        off = np.remainder(bearing - angles[beside] + np.pi, 2 * np.pi) - np.pi
        steps = np.diff(angles)
        steps = steps[steps > 1e-5]
        step = float(np.median(steps)) if len(steps) else math.inf
        silent = np.abs(off) > 1.5 * step
        if silent.any():
            # Steps are multiples of one; the beams beside are the next of that row.
            rest = np.remainder(off, step)
            off = np.where(silent, rest - np.array([[step], [0.0]]), off)
        beyond = silent | (ranges[beside] >= away + _BEYOND_M)
        return cls(off, away, bearing, beyond, silent)


def possible_directions(
    points: Points,
    hits: Points,
    sensor: tuple[float, float],
    resolution_m: float,
    crossed: Flags,
) -> Bits:
    """Return (M,) in which directions from each point a post may be after a scan.

    Args:
        points: (M, 2) middle of the points of a cell, in the map, m.
        hits: (N, 2) echoes, in the map, m.
        sensor: x, y in the map, m.
        resolution_m: edge of a cell of the map.
        crossed: (M,) whether beams crossed the cells of the point and :func:`behind`
            it; one without an echo proves nothing elsewhere.
    """
    possible = np.full(len(points), _ALL, np.uint32)
    if len(hits) < 2 or len(points) == 0:
        return possible
    beams = Beams.of(points, hits, sensor)
    aside = beams.away * np.abs(np.sin(beams.off))
    aside += _BEAM_ERROR_M + _BEAM_ERROR_RAD * beams.away
    reach = _RADIUS_M + _POINT_ERROR_M + resolution_m / 8 * math.sqrt(0.5)
    passed = beams.beyond & (np.abs(beams.off) < np.pi / 2)
    passed &= (aside < _RADIUS_M) & (crossed | ~beams.silent)
    for side in (0, 1):
        index = np.flatnonzero(passed[side])
        off, s = beams.off[side, index], aside[side, index]
        # The centre is away from the beam: on the side on which the point is.
        normal = beams.bearing[index] - off + np.copysign(math.pi / 2, off)
        half = np.arccos((_RADIUS_M - s) / reach) + _HALF_SECTOR
        gap = np.remainder(_ANGLES - normal[:, None] + np.pi, 2 * np.pi) - np.pi
        left = np.abs(gap) <= half[:, None]
        possible[index] &= (left * _BIT_VALUES).sum(axis=1, dtype=np.uint32)
    return possible
