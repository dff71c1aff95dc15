"""Obstacles that beams passed: objects that moved away, also at a distance.

At a distance, neighbouring beams pass a thin post on both sides and mark its cell free
without having measured it, so a free cell there proves nothing. A beam that passes the
point where an earlier beam ended proves that the obstacle is gone.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids import CellWindow, RowSpans, padded_sparse

Points = NDArray[np.float64]
Values = NDArray[np.float64]

_ASIDE_M = 0.007
"""Largest distance between a beam and a point that it passes."""
_BEYOND_M = 0.1
"""Least distance beyond the point at which the beam ends, against noise."""
_TIMES = 3
"""Number of scans without an echo in or beside a cell after which it is free."""


class VanishedCells:
    """Counts, per cell, the scans whose beams passed the points in it.

    ``shape`` is that of the map.
    """

    def __init__(self, shape: tuple[int, int]) -> None:
        self._passes = np.zeros(shape, np.uint8)

    def grow(
        self, pad: tuple[tuple[int, int], tuple[int, int]], written: RowSpans
    ) -> None:
        """Add cells around, as :func:`numpy.pad` does."""
        self._passes = padded_sparse(self._passes, pad, written)

    def update(
        self, cells: NDArray[np.int64], beside: NDArray[np.bool_], window: CellWindow
    ) -> NDArray[np.int64]:
        """Return the cells (K, 2) whose obstacles are gone.

        Args:
            cells: (N, 2) cells of the window with a point that a beam of this scan
                passed.
            beside: cells of the window with an echo in this scan, or beside one.
            window: the part of the map that the scan may change.
        """
        passes = self._passes[window.slices]
        passes[beside] = 0
        first = np.array((window.first_row, window.first_column))
        width = window.shape[1]
        rows, columns = np.divmod(
            np.unique((cells - first) @ np.array((width, 1))), max(width, 1)
        )
        still = ~beside[rows, columns]
        rows, columns = rows[still], columns[still]
        passes[rows, columns] += 1
        gone = passes[rows, columns] >= _TIMES
        rows, columns = rows[gone], columns[gone]
        passes[rows, columns] = 0
        vanished: NDArray[np.int64] = np.column_stack([rows, columns]) + first
        return vanished


def cells_beside(cells: NDArray[np.int64], window: CellWindow) -> NDArray[np.bool_]:
    """Return the cells (N, 2) and the eight around each, as a mask of a window."""
    height, width = window.shape
    mask = np.zeros((height + 4, width + 4), np.bool_)
    rows = cells[:, 0] - window.first_row + 2
    columns = cells[:, 1] - window.first_column + 2
    near = (rows >= 1) & (rows <= height + 2) & (columns >= 1) & (columns <= width + 2)
    rows, columns = rows[near], columns[near]
    for i in (-1, 0, 1):
        for j in (-1, 0, 1):
            mask[rows + i, columns + j] = True
    return mask[2:-2, 2:-2]


class Beams(NamedTuple):
    """Echoes of one scan as seen from the sensor, in the order of their angles.

    Attributes:
        angles, ranges: (N,) rad and m of the echoes.
        beside: (2, M) index of the echo after and before each point.
        off: (2, M) rad from these to the point.
        away: (M,) m from the sensor to the point.
    """

    angles: Values
    ranges: Values
    beside: NDArray[np.int64]
    off: Values
    away: Values

    @classmethod
    def of(cls, points: Points, hits: Points, sensor: tuple[float, float]) -> "Beams":
        """Args: points (M, 2) and echoes (N, 2), N > 0, in the map, m; sensor."""
        beams, there = hits - sensor, points - sensor
        angles = np.arctan2(beams[:, 1], beams[:, 0])
        order = np.argsort(angles)
        angles = angles[order]
        ranges = np.hypot(beams[order, 0], beams[order, 1])
        angle = np.arctan2(there[:, 1], there[:, 0])
        following = np.searchsorted(angles, angle)
        beside = np.stack([following, following - 1]) % len(angles)
        off = np.remainder(angle - angles[beside] + np.pi, 2 * np.pi) - np.pi
        return cls(angles, ranges, beside, off, np.hypot(there[:, 0], there[:, 1]))


def without_echo(
    points: Points, hits: Points, sensor: tuple[float, float], spacing_m: float
) -> NDArray[np.bool_]:
    """Return (M,) whether only beams without an echo can have gone through each point.

    No beam beside the point has an echo, and beams there are at most ``spacing_m``
    apart, so that something as wide would have ended one.
    """
    if len(hits) < 2 or len(points) == 0:
        return np.zeros(len(points), np.bool_)
    return _without_echo(Beams.of(points, hits, sensor), spacing_m)


def passed(
    points: Points, hits: Points, sensor: tuple[float, float]
) -> NDArray[np.bool_]:
    """Return (M,) whether a beam went through each point and ended well beyond it."""
    if len(hits) == 0 or len(points) == 0:
        return np.zeros(len(points), np.bool_)
    return _passed(Beams.of(points, hits, sensor))


def passed_or_without_echo(
    points: Points, hits: Points, sensor: tuple[float, float], spacing_m: float
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return :func:`passed` and :func:`without_echo` of the same points."""
    if len(hits) < 2 or len(points) == 0:
        none = np.zeros(len(points), np.bool_)
        return passed(points, hits, sensor), none
    beams = Beams.of(points, hits, sensor)
    return _passed(beams), _without_echo(beams, spacing_m)


def _without_echo(beams: Beams, spacing_m: float) -> NDArray[np.bool_]:
    steps = np.diff(beams.angles)
    steps = steps[steps > 1e-5]
    step = float(np.median(steps)) if len(steps) else np.inf
    nearest = np.abs(beams.off).min(axis=0)
    return np.asarray((nearest > 1.5 * step) & (beams.away * step <= spacing_m))


def _passed(beams: Beams) -> NDArray[np.bool_]:
    aside = beams.away * np.abs(np.sin(beams.off)) <= _ASIDE_M
    aside &= np.abs(beams.off) < np.pi / 2
    aside &= beams.ranges[beams.beside] >= beams.away + _BEYOND_M
    return np.asarray(aside.any(axis=0))
