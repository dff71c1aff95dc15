"""Group the returns of a scan into obstacles, and measure centre and radius."""

import itertools
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
    circle, so that the centre is accurate. ``is_whole``: neither something nearer nor
    the end of the scan hides a part, so that the radius is known.
    """

    x: float
    y: float
    radius_m: float
    is_round: bool
    is_whole: bool
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
    allocates=False,
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


def convex_parts(
    points: Points, sensor: tuple[float, float], depth_m: float
) -> list[NDArray[np.int64]]:
    """Return the indices of neighbouring returns, divided where the surface recedes.

    The near side of one convex obstacle bulges towards the sensor. Where returns lie
    ``depth_m`` behind the hull on the sensor's side, two obstacles meet.

    Args:
        points: (N, 2) neighbouring returns in the order of their beams, m.
        sensor: position, m.
        depth_m: must exceed the noise of the ranges.
    """
    if not len(points):
        return []
    ends = [0]
    waiting = [(0, len(points))]
    while waiting:
        first, stop = waiting.pop()
        at = _deepest(points[first:stop], sensor[0], sensor[1], depth_m)
        if at > 0:
            waiting += [(first + at, stop), (first, first + at)]
        else:
            ends.append(stop)
    return [np.arange(*each) for each in itertools.pairwise(ends)]


@kernel(signature="int64(float64[:, ::1], float64, float64, float64)")
def _deepest(points: Points, x: float, y: float, depth: float) -> int:
    """Return the index of the return farthest behind the hull; 0: none is so far."""
    count = points.shape[0]
    if count < 3:
        return 0
    ax, ay = points[0, 0] - x, points[0, 1] - y
    bx, by = points[count - 1, 0] - x, points[count - 1, 1] - y
    side = 1.0 if ax * by - ay * bx >= 0.0 else -1.0  # the beams' direction of turn
    hull = np.empty(count, np.int64)
    size = 0
    for k in range(count):
        while size >= 2:
            i, j = hull[size - 2], hull[size - 1]
            ax, ay = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1]
            bx, by = points[k, 0] - points[j, 0], points[k, 1] - points[j, 1]
            if side * (ax * by - ay * bx) < 0.0:
                break
            size -= 1
        hull[size] = k
        size += 1
    found = 0
    for h in range(size - 1):
        i, j = hull[h], hull[h + 1]
        ax, ay = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1]
        length = math.sqrt(ax * ax + ay * ay)
        for k in range(i + 1, j):
            bx, by = points[k, 0] - points[i, 0], points[k, 1] - points[i, 1]
            behind = abs(ax * by - ay * bx) / max(length, 1e-9)
            if behind > depth:
                depth, found = behind, k
    return found


def is_whole(ranges: NDArray[np.float32], first: int, stop: int, turn: float) -> bool:
    """Return whether beams pass behind a run of returns at both of its ends.

    Args:
        ranges: (N,) of the scan, m.
        first, stop: half-open interval of the run's beams.
        turn: angle that the N beams cover, rad; a whole turn has no end.
    """
    count = len(ranges)
    closed = turn > 2 * math.pi - 1e-3
    for end, beside in ((first, first - 1), (stop - 1, stop)):
        if not (closed or 0 <= beside < count):
            return False
        if not ranges[beside % count] > ranges[end]:  # also not a number
            return False
    return True


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
