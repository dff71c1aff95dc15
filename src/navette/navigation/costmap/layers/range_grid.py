"""Obstacles from range readings of a cone, after Nav2's RangeSensorLayer.

A reading proves that its cone is free up to the range, and that something is at that
range somewhere across the cone. Each cell keeps a probability, which readings update by
Bayes' rule with a sensor model: most certain on the axis and near the sensor, where
``phi`` is the range at which the certainty has fallen to a half.
"""

import math

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]

_PRIOR = 0.5
_LIMITS = (0.02, 0.98)  # so that a few readings can change a cell again


class RangeWindow:
    """Probabilities of obstacles in a square of ``size_m`` around the robot."""

    def __init__(self, size_m: float, resolution: float, phi: float) -> None:
        self.resolution = resolution
        self._phi = phi
        self._count = max(1, math.ceil(size_m / resolution - 1e-9))
        self._cells = np.full((self._count, self._count), _PRIOR)
        self._corner: tuple[int, int] | None = None
        self._is_used = False  # whether there was a reading

    def reset(self) -> None:
        """Forget all readings."""
        self._cells[:] = _PRIOR
        self._is_used = False

    def move_to(self, x: float, y: float) -> None:
        """Centre the window on a point; what leaves it is forgotten."""
        half, r = self._count // 2, self.resolution
        corner = math.floor(x / r) - half, math.floor(y / r) - half
        before, self._corner = self._corner, corner
        if before is None or before == corner or not self._is_used:
            return
        kept = np.full_like(self._cells, _PRIOR)
        dx, dy = corner[0] - before[0], corner[1] - before[1]
        n = self._count
        if abs(dx) < n and abs(dy) < n:
            kept[max(0, -dy) : n - max(0, dy), max(0, -dx) : n - max(0, dx)] = (
                self._cells[max(0, dy) : n - max(0, -dy), max(0, dx) : n - max(0, -dx)]
            )
        self._cells = kept

    def update(
        self,
        sensor: tuple[float, float, float],
        reading: float,
        half_angle: float,
        *,
        is_free: bool = False,
    ) -> None:
        """Update the cells of a cone.

        Args:
            sensor: x, y (m) and heading (rad).
            reading: m.
            half_angle: of the cone, rad.
            is_free: nothing was found up to ``reading``: no cell becomes more probable.
        """
        if self._corner is None:
            return
        self._is_used = True
        x, y, yaw = sensor
        reach = reading + 2.0 * self.resolution
        rows, columns, centres = self._around(_corners(sensor, reach, half_angle))
        dx, dy = centres[:, 0] - x, centres[:, 1] - y
        distance = np.hypot(dx, dy)
        bearing = np.abs(np.angle(np.exp(1j * (np.arctan2(dy, dx) - yaw))))
        touched = (bearing <= half_angle) & (distance <= reach)
        rows, columns = rows[touched], columns[touched]
        share = (bearing[touched] / max(half_angle, 1e-6), distance[touched])
        model = sensor_model(reading, *share, phi=self._phi, resolution=self.resolution)
        if is_free:
            model = np.minimum(model, _PRIOR)
        prior = self._cells[rows, columns]
        posterior = model * prior / (model * prior + (1.0 - model) * (1.0 - prior))
        self._cells[rows, columns] = np.clip(posterior, *_LIMITS)

    def obstacles(self, mark_threshold: float) -> Points:
        """Return the centres (N, 2) of the cells above a probability, m."""
        if not self._is_used:
            return np.empty((0, 2))
        rows, columns = np.nonzero(self._cells > mark_threshold)
        return self._centres(rows, columns)

    def _around(
        self, points: Points
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], Points]:
        """Return rows, columns and centres of the cells around points (N, 2)."""
        assert self._corner is not None, "called after move_to()"
        low = np.floor(points.min(axis=0) / self.resolution) - self._corner
        high = np.floor(points.max(axis=0) / self.resolution) - self._corner
        first = np.clip(low, 0, self._count).astype(np.int64)
        last = np.clip(high + 1, 0, self._count).astype(np.int64)
        grid = np.meshgrid(
            np.arange(first[1], last[1]), np.arange(first[0], last[0]), indexing="ij"
        )
        rows, columns = (each.ravel() for each in grid)
        return rows, columns, self._centres(rows, columns)

    def _centres(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> Points:
        assert self._corner is not None, "called after move_to()"
        index = np.stack([columns, rows], axis=1) + np.array(self._corner)
        centres: Points = (index + 0.5) * self.resolution
        return centres


def _corners(
    sensor: tuple[float, float, float], reach: float, half_angle: float
) -> Points:
    """Return points (N, 2) around a cone; see :meth:`RangeWindow.update`."""
    x, y, yaw = sensor
    half, count = min(half_angle, math.pi), 16
    angles = yaw + np.linspace(-half, half, count + 1)
    outer = reach / math.cos(half / count)  # of the polygon around the arc
    arc = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return np.concatenate([[(x, y)], (x, y) + outer * arc])


def sensor_model(
    reading: float,
    bearing: NDArray[np.float64],
    distance: NDArray[np.float64],
    *,
    phi: float,
    resolution: float,
) -> NDArray[np.float64]:
    """Return the probability of an obstacle at points of the cone, given a reading.

    Args:
        reading: m.
        bearing: (N,) share of the half angle, 0 on the axis … 1 at the edge.
        distance: (N,) of the points from the sensor, m.
        phi: range of half certainty, m.
        resolution: half width of the arc, m.
    """
    certainty = 1.0 - (1.0 + np.tanh(2.0 * (distance - phi))) / 2.0
    certainty = certainty * (1.0 - bearing**2)
    model = np.full(len(distance), _PRIOR)
    off = (distance - reading) / resolution
    before = off < -2.0
    rising = (off >= -2.0) & (off < -1.0)
    on = np.abs(off) <= 1.0
    model[before] = _PRIOR * (1.0 - certainty[before])
    ramp = (off[rising] + 2.0) ** 2
    model[rising] = _PRIOR * (1.0 - certainty[rising] * (1.0 - ramp))
    arc = 1.0 - 0.5 * off[on] ** 2
    model[on] = _PRIOR + certainty[on] * (arc - _PRIOR)
    return model
