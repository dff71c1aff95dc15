"""Pose of a scan on a point map, far below the size of a cell.

Gauss-Newton over the distances of points from the surface near them. The surface is the
weighted mean of the map's points and normals within a radius (implicit moving least
squares; Kolluri 2005, and for scans Deschaud 2018), which averages the noise of several
scans. The residual is the distance along the normal (Chen and Medioni 1992), so that a
corridor gives no information along itself.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Pose2, wrap_angle
from navette.navigation.slam.motion import Matrix3
from navette.navigation.slam.point_map import PointMap
from navette.navigation.slam.scan_points import Points

# Normals of one surface differ less than this (cosine): both sides of a wall do not.
_SAME_SIDE = 0.7
# Standard deviation of a normal, rad. The normals of a bare corridor differ by it, and
# seem to measure along the corridor: towards where the map has more points, back.
_NORMAL_RAD = 0.05
# Share of the information that is left where the normals' noise explains all of it.
_DEGENERATE = 1e-3
# Weight of a point without a surface: legs, leaves, corners.
_SCATTERED = 0.2
_CONVERGED_M = 1e-4
_STEPS = 12


class PosePrior(NamedTuple):
    """A Gaussian belief about the pose, in the map's frame."""

    pose: Pose2
    information: Matrix3


class Refined(NamedTuple):
    """A refined pose.

    Attributes:
        pose: of the scan in the map's frame.
        information: (3, 3) inverse covariance of x, y (map frame) and yaw, of the
            match alone.
        overlap: share of points with a correspondence.
        error_m: root mean square distance of these from the surface, m.
    """

    pose: Pose2
    information: Matrix3
    overlap: float
    error_m: float

    def fit(self, noise_m: float) -> float:
        """Return the share of corresponding points, less where they are far off."""
        error = self.error_m / noise_m
        return self.overlap / (1.0 + error * error)


NO_PRIOR = PosePrior(Pose2(0.0, 0.0, 0.0), np.zeros((3, 3)))


def refine(
    surface: PointMap,
    points: Points,
    start: Pose2,
    *,
    noise_m: float,
    prior: PosePrior = NO_PRIOR,
    steps: int = _STEPS,
) -> Refined:
    """Return the pose near ``start`` at which the points lie on the surface.

    Args:
        surface: the map; points correspond within its cell size.
        points: (N, 4) of the scan in its own frame.
        start: first pose.
        noise_m: standard deviation of a point's distance from the surface.
        prior: a belief that is fused with the match.
        steps: most iterations.
    """
    pose = np.array(start)
    information = np.zeros((3, 3))
    quality = np.zeros(2)
    _refine_kernel(
        surface,
        points,
        pose,
        np.array(prior.pose),
        prior.information,
        noise_m,
        steps,
        information,
        quality,
    )
    x, y, yaw = (float(value) for value in pose)
    return Refined(
        Pose2(x, y, wrap_angle(yaw)), information, float(quality[0]), float(quality[1])
    )


@kernel
def _refine_kernel(
    surface: PointMap,
    points: Points,
    pose: NDArray[np.float64],
    prior_pose: NDArray[np.float64],
    prior_information: Matrix3,
    noise_m: float,
    steps: int,
    information: Matrix3,
    quality: NDArray[np.float64],
) -> None:
    gradient, right, step = np.empty(3), np.empty(3), np.empty(3)
    for k in range(steps + 1):
        # First over the whole radius, then over the surface nearby.
        radius = surface.cell_m if k < 3 else 0.5 * surface.cell_m
        sum_equations(
            surface, points, pose, noise_m, radius, information, gradient, quality
        )
        if k == steps:
            return
        away = pose - prior_pose
        away[2] -= math.tau * math.floor(away[2] / math.tau + 0.5)
        total = information + prior_information
        for i in range(3):
            right[i] = -gradient[i]
            for j in range(3):
                right[i] -= prior_information[i, j] * away[j]
        if not solve(total, right, step):
            return
        size = math.sqrt(step[0] * step[0] + step[1] * step[1]) + abs(step[2])
        if size > surface.cell_m:
            step *= surface.cell_m / size
        pose += step
        if size < _CONVERGED_M and k > 3:
            return


@kernel
def sum_equations(
    surface: PointMap,
    points: Points,
    pose: NDArray[np.float64],
    noise_m: float,
    radius: float,
    information: Matrix3,
    gradient: NDArray[np.float64],
    quality: NDArray[np.float64],
) -> None:
    """Write the normal equations of all points at a pose.

    ``quality`` becomes the share of corresponding points and their error, m.
    """
    c, s = math.cos(pose[2]), math.sin(pose[2])
    information[:] = 0.0
    gradient[:] = 0.0
    count, squares = 0, 0.0
    found = np.empty(3)
    for i in range(points.shape[0]):
        rx = c * points[i, 0] - s * points[i, 1]
        ry = s * points[i, 0] + c * points[i, 1]
        nx = c * points[i, 2] - s * points[i, 3]
        ny = s * points[i, 2] + c * points[i, 3]
        kind = surface_near(surface, pose[0] + rx, pose[1] + ry, nx, ny, radius, found)
        if kind == 0:
            continue
        count += 1
        if kind == 1:
            mx, my, error = found[0], found[1], found[2]
            squares += error * error
            _add(information, gradient, mx, my, rx, ry, error, 1.0, noise_m)
        else:
            squares += found[0] * found[0] + found[1] * found[1]
            _add(information, gradient, 1.0, 0.0, rx, ry, found[0], _SCATTERED, noise_m)
            _add(information, gradient, 0.0, 1.0, rx, ry, found[1], _SCATTERED, noise_m)
    _remove_normal_noise(information, gradient)
    quality[0] = count / max(1, points.shape[0])
    quality[1] = math.sqrt(squares / max(1, count))


@kernel(allocates=False)
def _remove_normal_noise(information: Matrix3, gradient: NDArray[np.float64]) -> None:
    """Remove what the noise of the normals seems to measure, in the weakest direction.

    Where that is all, the direction is degenerate: the prior decides there (solution
    remapping; Zhang, Kaess and Singh 2016).
    """
    a, b, c = information[0, 0], information[0, 1], information[1, 1]
    half = (a - c) / 2.0
    weakest = (a + c) / 2.0 - math.sqrt(half * half + b * b)
    noise = _NORMAL_RAD * _NORMAL_RAD * (a + c)
    if noise <= 0.0:
        return
    share = max(_DEGENERATE, 1.0 - noise / max(weakest, noise))
    angle = 0.5 * math.atan2(2.0 * b, a - c) + math.pi / 2.0
    x, y = math.cos(angle), math.sin(angle)
    # D = I − (1 − √share) d dᵀ; information D M D, gradient D² g.
    lost = 1.0 - math.sqrt(share)
    for k in range(3):
        along = lost * (x * information[0, k] + y * information[1, k])
        information[0, k] -= x * along
        information[1, k] -= y * along
    for k in range(3):
        along = lost * (x * information[k, 0] + y * information[k, 1])
        information[k, 0] -= x * along
        information[k, 1] -= y * along
    along = (1.0 - share) * (x * gradient[0] + y * gradient[1])
    gradient[0] -= x * along
    gradient[1] -= y * along


@kernel(allocates=False)
def _add(
    information: Matrix3,
    gradient: NDArray[np.float64],
    mx: float,
    my: float,
    rx: float,
    ry: float,
    error: float,
    weight: float,
    noise_m: float,
) -> None:
    """Add one residual: distance ``error`` along (mx, my) at the lever (rx, ry)."""
    j2 = mx * -ry + my * rx
    # Cauchy's weight: a point on another object pulls little.
    w = weight / (noise_m * noise_m + error * error)
    information[0, 0] += w * mx * mx
    information[0, 1] += w * mx * my
    information[0, 2] += w * mx * j2
    information[1, 1] += w * my * my
    information[1, 2] += w * my * j2
    information[2, 2] += w * j2 * j2
    information[1, 0] = information[0, 1]
    information[2, 0] = information[0, 2]
    information[2, 1] = information[1, 2]
    gradient[0] += w * mx * error
    gradient[1] += w * my * error
    gradient[2] += w * j2 * error


@kernel(allocates=False)
def surface_near(
    surface: PointMap,
    x: float,
    y: float,
    nx: float,
    ny: float,
    radius: float,
    found: NDArray[np.float64],
) -> int:
    """Find the surface near a point.

    Returns 1 and its normal and distance in ``found``, 2 and the offset (x, y) from
    the mean of scattered points, or 0.
    """
    height, width = surface.shape
    column = math.floor((x - surface.x) / surface.cell_m)
    row = math.floor((y - surface.y) / surface.cell_m)
    has_normal = nx * nx + ny * ny > 0.5
    limit = radius * radius
    total, sx, sy, mx, my, distance = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for r in range(max(0, row - 1), min(height, row + 2)):
        first = surface.starts[r * width + min(max(0, column - 1), width)]
        last = surface.starts[r * width + min(max(0, column + 2), width)]
        for k in range(first, last):
            dx, dy = x - surface.points[k, 0], y - surface.points[k, 1]
            squared = dx * dx + dy * dy
            if squared >= limit:
                continue
            qx, qy = surface.points[k, 2], surface.points[k, 3]
            if has_normal:
                if qx * nx + qy * ny < _SAME_SIDE:
                    continue
            elif qx * qx + qy * qy > 0.5:
                continue
            w = 1.0 - squared / limit
            w *= w
            total += w
            sx, sy = sx + w * dx, sy + w * dy
            mx, my = mx + w * qx, my + w * qy
            distance += w * (qx * dx + qy * dy)
    if total <= 1e-6:
        return 0
    if not has_normal:
        found[0], found[1] = sx / total, sy / total
        return 2
    length = math.sqrt(mx * mx + my * my)
    found[0], found[1], found[2] = mx / length, my / length, distance / total
    return 1


@kernel(allocates=False)
def solve(
    matrix: Matrix3, right: NDArray[np.float64], solution: NDArray[np.float64]
) -> bool:
    """Solve a symmetric positive definite 3 × 3 system by Cholesky's method."""
    a = matrix
    scale = max(a[0, 0], a[1, 1], 1e-12)
    small = 1e-9 * scale
    l00 = math.sqrt(max(a[0, 0], small))
    l10, l20 = a[1, 0] / l00, a[2, 0] / l00
    d1 = a[1, 1] - l10 * l10
    if d1 < small:
        return False
    l11 = math.sqrt(d1)
    l21 = (a[2, 1] - l20 * l10) / l11
    d2 = a[2, 2] - l20 * l20 - l21 * l21
    if d2 < small:
        return False
    l22 = math.sqrt(d2)
    y0 = right[0] / l00
    y1 = (right[1] - l10 * y0) / l11
    y2 = (right[2] - l20 * y0 - l21 * y1) / l22
    solution[2] = y2 / l22
    solution[1] = (y1 - l21 * solution[2]) / l11
    solution[0] = (y0 - l10 * solution[1] - l20 * solution[2]) / l00
    return True
