"""Group the returns of a scan into obstacles, and measure centre and radius."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel

Points = NDArray[np.float64]

_LEAST_RADIUS_M = 0.05
_LEAST_POINTS_OF_CIRCLE = 5
# Largest root mean square distance of the returns from a fitted circle.
_CIRCLE_ERROR_M = 0.04
# Neighbouring returns are farther apart at a distance: metres per metre.
_GAP_GROWTH = 0.015
_FIT_STEPS, _FIT_DAMPING = 5, 0.02
# The mean of the returns of a half circle lies this share of the radius before the
# centre.
_MEAN_BEFORE_CENTRE = 0.785


class Cluster(NamedTuple):
    """An obstacle in one scan: a circle (m, map), and how it was measured.

    ``changed`` of its returns were not there before. ``is_round``: the returns lie on a
    circle, so that the centre is accurate.
    """

    x: float
    y: float
    radius_m: float
    is_round: bool
    changed: int


def segment(
    points: Points, valid: NDArray[np.bool_], away: Points, gap_m: float
) -> NDArray[np.int64]:
    """Return (K, 2) first and stop beam of each run of neighbouring returns.

    Args:
        points: (N, 2) returns, m.
        valid: (N,) whether a return exists.
        away: (N,) their distances from the sensor, m.
        gap_m: largest distance between neighbours close to the sensor.
    """
    runs = np.empty((len(points), 2), np.int64)
    count = _segment_kernel(points, valid, away, gap_m, runs)
    return runs[:count]


@kernel(
    signature="int64(float64[:, ::1], boolean[::1], float64[::1], float64,"
    " int64[:, ::1])",
)
def _segment_kernel(
    points: Points,
    valid: NDArray[np.bool_],
    away: Points,
    gap_m: float,
    runs: NDArray[np.int64],
) -> int:
    count = 0
    last = -10
    for i in range(points.shape[0]):
        if not valid[i]:
            continue
        joined = False
        if i - last <= 2:  # one lost beam does not separate
            dx = points[i, 0] - points[last, 0]
            dy = points[i, 1] - points[last, 1]
            gap = gap_m + _GAP_GROWTH * away[i]
            joined = dx * dx + dy * dy <= gap * gap
        if not joined:
            runs[count, 0] = i
            count += 1
        runs[count - 1, 1] = i + 1
        last = i
    return count


def extent(points: Points) -> float:
    """Return the diagonal (m) of the box around points (N, 2)."""
    span = points.max(axis=0) - points.min(axis=0)
    return float(math.hypot(*span))


def fit_disc(
    points: Points, sensor: tuple[float, float], largest_m: float
) -> tuple[float, float, float, bool]:
    """Return centre and radius (m) of the disc whose near side has these returns.

    The last value is whether they lie on a circle.

    Kåsa's circle fit (1976) if the returns lie on a circle, otherwise a disc as wide as
    the returns, behind them.

    Args:
        points: (N, 2) in the map, m, N >= 1.
        sensor: position in the map, m.
        largest_m: largest radius.
    """
    middle = points.mean(axis=0)
    if len(points) >= _LEAST_POINTS_OF_CIRCLE:
        u, v = (points - middle).T
        square = u * u + v * v
        matrix = np.array([[u @ u, u @ v], [u @ v, v @ v]])
        determinant = matrix[0, 0] * matrix[1, 1] - matrix[0, 1] ** 2
        if determinant > 1e-12:
            p, q = 0.5 * (square @ u), 0.5 * (square @ v)
            a = (p * matrix[1, 1] - q * matrix[0, 1]) / determinant
            b = (q * matrix[0, 0] - p * matrix[0, 1]) / determinant
            radius = math.sqrt(a * a + b * b + float(square.mean()))
            error = np.hypot(u - a, v - b) - radius
            dx, dy = middle[0] - sensor[0], middle[1] - sensor[1]
            behind = a * dx + b * dy > 0.0
            if (
                behind
                and _LEAST_RADIUS_M <= radius <= largest_m
                and float(error @ error) <= len(points) * _CIRCLE_ERROR_M**2
            ):
                return float(middle[0] + a), float(middle[1] + b), radius, True
    radius = max(_LEAST_RADIUS_M, min(largest_m, extent(points) / 2))
    return behind_returns(middle, sensor, radius)


def fit_centre(
    points: Points, start: tuple[float, float], radius_m: float
) -> tuple[float, float, float, bool]:
    """Return the disc of a known radius on whose circle the returns lie.

    Gauss-Newton steps from ``start``, damped: where a hidden obstacle shows a short arc
    only, the centre stays near the start in the direction that the arc leaves open. The
    last value is whether the returns lie on the circle.
    """
    centre = np.array(start)
    for _ in range(_FIT_STEPS):
        arms = points - centre
        lengths = np.maximum(np.hypot(arms[:, 0], arms[:, 1]), 1e-6)
        units = arms / lengths[:, None]
        error = lengths - radius_m
        normal = units.T @ units + _FIT_DAMPING * len(points) * np.eye(2)
        centre = centre + np.linalg.solve(normal, units.T @ error)
    error = np.hypot(*(points - centre).T) - radius_m
    fits = float(error @ error) <= len(points) * _CIRCLE_ERROR_M**2
    return float(centre[0]), float(centre[1]), radius_m, fits


def behind_returns(
    middle: NDArray[np.float64], sensor: tuple[float, float], radius_m: float
) -> tuple[float, float, float, bool]:
    """Return the disc of a radius whose returns have this mean (m, map)."""
    dx, dy = middle[0] - sensor[0], middle[1] - sensor[1]
    away = math.hypot(dx, dy) or 1.0
    shift = _MEAN_BEFORE_CENTRE * radius_m / away
    x, y = middle[0] + shift * dx, middle[1] + shift * dy
    return float(x), float(y), radius_m, False
