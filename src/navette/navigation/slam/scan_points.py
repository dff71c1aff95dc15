"""Points and surface normals of a planar scan."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Pose2
from navette.navigation.grids import PlanarScan

Points = NDArray[np.float64]
"""(N, 4): x, y, m, and the unit normal towards the sensor; 0, 0 without a surface."""

LEAST_POINTS = 10
"""Points without which a scan is not matched."""

# Beams on each side of a point that its normal is fitted to, and how far away they may
# be: so far that range noise of 2 cm turns a normal by a few degrees only.
_SIDE_BEAMS = 6
_SIDE_M = 0.5
# Neighbouring echoes belong to one surface unless they are farther apart than those of
# a wall that the beams meet at about 10°.
_STEEPEST = 6.0
_LEAST_GAP_M = 0.1
# Largest standard deviation of the points from the fitted line.
_FLAT_M = 0.03


class _Beams(NamedTuple):
    ranges: NDArray[np.float32]
    angle_min: float
    angle_increment: float
    range_min: float
    range_max: float


def scan_points(
    scan: PlanarScan,
    base_T_sensor: Pose2,
    *,
    max_range_m: float,
    spacing_m: float,
    max_points: int,
) -> Points:
    """Return the echoes of a scan in the base frame, with surface normals.

    Neighbouring points are at least ``spacing_m`` apart, or more where the scan has
    more than ``max_points`` of them. A normal is fitted to the neighbouring beams on
    the same surface (total least squares).
    """
    beams = _Beams(
        np.ascontiguousarray(scan.ranges, np.float32),
        float(scan.angle_min),
        float(scan.angle_increment),
        float(scan.range_min),
        min(float(scan.range_max), max_range_m),
    )
    pose = np.array(base_T_sensor)
    every: Points = _points_kernel(beams, pose)
    kept: Points = _thinned(every, spacing_m)
    while len(kept) > max_points:
        spacing_m = max(0.02, 1.25 * spacing_m)
        thinner: Points = _thinned(every, spacing_m)
        if len(thinner) == len(kept) and spacing_m > 10.0:
            return np.ascontiguousarray(kept[:: -(-len(kept) // max_points)])
        kept = thinner
    return kept


def moved_points(points: Points, pose: Pose2) -> Points:
    """Return points with their normals in the outer frame of ``pose``."""
    c, s = math.cos(pose.yaw), math.sin(pose.yaw)
    rotation = np.array([[c, s], [-s, c]])
    moved = np.empty_like(points)
    moved[:, :2] = points[:, :2] @ rotation + (pose.x, pose.y)
    moved[:, 2:] = points[:, 2:] @ rotation
    return moved


def thinned(points: Points, most: int) -> Points:
    """Return at most ``most`` of the points, evenly spread over their order."""
    return np.ascontiguousarray(points[:: max(1, -(-len(points) // most))])


@kernel
def _points_kernel(beams: _Beams, base_T_sensor: NDArray[np.float64]) -> Points:
    count = beams.ranges.size
    echoes = np.empty((count, 2))
    is_valid = np.zeros(count, np.bool_)
    for i in range(count):
        r = beams.ranges[i]
        if beams.range_min < r < beams.range_max:
            angle = beams.angle_min + i * beams.angle_increment
            echoes[i, 0], echoes[i, 1] = r * math.cos(angle), r * math.sin(angle)
            is_valid[i] = True
    cos, sin = math.cos(base_T_sensor[2]), math.sin(base_T_sensor[2])
    points, sums = np.empty((count, 4)), np.empty(6)
    size = 0
    for i in range(count):
        if not is_valid[i]:
            continue
        nx, ny = _normal(echoes, is_valid, beams, i, sums)
        if nx == 0.0 and ny == 0.0 and _is_behind(is_valid, beams, i):
            continue
        x, y = echoes[i, 0], echoes[i, 1]
        points[size, 0] = base_T_sensor[0] + cos * x - sin * y
        points[size, 1] = base_T_sensor[1] + sin * x + cos * y
        points[size, 2] = cos * nx - sin * ny
        points[size, 3] = sin * nx + cos * ny
        size += 1
    return points[:size].copy()


@kernel(allocates=False)
def _normal(
    echoes: NDArray[np.float64],
    is_valid: NDArray[np.bool_],
    beams: _Beams,
    i: int,
    sums: NDArray[np.float64],
) -> tuple[float, float]:
    """Return the normal of the surface at echo i, towards the sensor, or (0, 0).

    ``sums`` (6,) is overwritten.
    """
    sums[:5], sums[5] = 0.0, 1.0
    _add_side(echoes, is_valid, beams, i, -1, sums)
    _add_side(echoes, is_valid, beams, i, 1, sums)
    count = sums[5]
    if count < 3.0:
        return 0.0, 0.0
    sxx = sums[2] - sums[0] * sums[0] / count
    sxy = sums[3] - sums[0] * sums[1] / count
    syy = sums[4] - sums[1] * sums[1] / count
    # Eigenvalues of the scatter matrix.
    mean, half = (sxx + syy) / 2.0, (sxx - syy) / 2.0
    root = math.sqrt(half * half + sxy * sxy)
    small, large = max(0.0, mean - root), mean + root
    if math.sqrt(small / count) > _FLAT_M or small > 0.1 * large:
        return 0.0, 0.0
    along = 0.5 * math.atan2(2.0 * sxy, sxx - syy)
    nx, ny = -math.sin(along), math.cos(along)
    if nx * echoes[i, 0] + ny * echoes[i, 1] > 0.0:
        return -nx, -ny
    return nx, ny


@kernel(allocates=False)
def _is_behind(is_valid: NDArray[np.bool_], beams: _Beams, i: int) -> bool:
    """Whether a neighbouring beam ends before echo i.

    Without a normal, such an echo is on a wall that the beams meet at so small an angle
    that they hit it far apart, or at the edge of a shadow. Its place on the surface
    moves with the sensor: matched with those of other scans, it would hold the robot
    back, by 5 % of the length of a bare corridor.
    """
    for j in (i - 1, i + 1):
        if (
            0 <= j < beams.ranges.size
            and is_valid[j]
            and beams.ranges[i] - beams.ranges[j] > _LEAST_GAP_M
        ):
            return True
    return False


@kernel(allocates=False)
def _add_side(
    echoes: NDArray[np.float64],
    is_valid: NDArray[np.bool_],
    beams: _Beams,
    i: int,
    side: int,
    sums: NDArray[np.float64],
) -> None:
    """Add the echoes on the same surface, on one side of echo i."""
    before = i
    for step in range(1, _SIDE_BEAMS + 1):
        j = i + side * step
        if not 0 <= j < beams.ranges.size or not is_valid[j]:
            return
        near = min(beams.ranges[j], beams.ranges[before])
        gap = max(_LEAST_GAP_M, _STEEPEST * abs(beams.angle_increment) * near)
        if _squared(echoes, before, j) > gap * gap:
            return
        # At least one beam on each side counts, however far apart the beams are.
        if step > 1 and _squared(echoes, i, j) > _SIDE_M * _SIDE_M:
            return
        _add_echo(echoes, i, j, sums)
        before = j


@kernel(allocates=False)
def _squared(echoes: NDArray[np.float64], i: int, j: int) -> float:
    """Return the squared distance of two echoes."""
    dx, dy = echoes[j, 0] - echoes[i, 0], echoes[j, 1] - echoes[i, 1]
    squared: float = dx * dx + dy * dy
    return squared


@kernel(allocates=False)
def _add_echo(
    echoes: NDArray[np.float64], i: int, j: int, sums: NDArray[np.float64]
) -> None:
    """Add echo j, relative to echo i, to the sums of x, y, xx, xy, yy and 1."""
    dx, dy = echoes[j, 0] - echoes[i, 0], echoes[j, 1] - echoes[i, 1]
    sums[0] += dx
    sums[1] += dy
    sums[2] += dx * dx
    sums[3] += dx * dy
    sums[4] += dy * dy
    sums[5] += 1.0


@kernel
def _thinned(points: Points, spacing_m: float) -> Points:
    """Keep points that are ``spacing_m`` away from the one kept before."""
    kept = np.empty_like(points)
    size = 0
    for i in range(points.shape[0]):
        if size:
            dx = points[i, 0] - kept[size - 1, 0]
            dy = points[i, 1] - kept[size - 1, 1]
            if dx * dx + dy * dy < spacing_m * spacing_m:
                continue
        kept[size] = points[i]
        size += 1
    return kept[:size].copy()
