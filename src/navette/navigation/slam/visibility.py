"""Contradictions between scans: surfaces where another scan sees free space.

Points without a correspondence are not evidence against a pose by themselves: they may
be a part of the building that is new. In a place that another scan has seen through,
there is no surface (negative evidence; Thrun, Burgard, Fox 2005, section 6.4).
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Pose2
from navette.navigation.grids import PlanarScan
from navette.navigation.slam.point_map import PointMap
from navette.navigation.slam.refinement import surface_near
from navette.navigation.slam.scan_points import Points

# A beam sees through a point that it passes by this, plus a share of the distance.
_MARGIN_M, _MARGIN_SHARE = 0.3, 0.03
# Share of points below which they prove nothing.
_LEAST_DECIDABLE = 0.05


class SensorView(NamedTuple):
    """A scan and the pose of its sensor."""

    scan: PlanarScan
    pose: Pose2


class Views(NamedTuple):
    """Scans that points are compared with.

    Attributes:
        ranges: (K, B) float32, NaN where a beam is missing or without an echo.
        sensors: (K, 6) x, y, yaw, angle of the first beam, increment, number of beams.
    """

    ranges: NDArray[np.float32]
    sensors: NDArray[np.float64]


def make_views(scans: Sequence[SensorView]) -> Views:
    """Return the views of placed scans."""
    most = max((len(each.scan.ranges) for each in scans), default=0)
    ranges = np.full((len(scans), most), np.nan, np.float32)
    sensors = np.empty((len(scans), 6))
    for k, (scan, pose) in enumerate(scans):
        echo = (scan.ranges > scan.range_min) & (scan.ranges < scan.range_max)
        ranges[k, : len(echo)] = np.where(echo, scan.ranges, np.nan)
        sensors[k] = (*pose, scan.angle_min, scan.angle_increment, len(echo))
    return Views(ranges, sensors)


def contradicted_share(
    surface: PointMap, views: Views, points: Points, pose: Pose2
) -> float:
    """Return the share of points that a view sees through, 0 to 1.

    Of the points (N, 4) at ``pose`` that are decidable: the others have a corresponding
    surface.
    """
    supported, seen_through = _compare_kernel(surface, views, points, np.array(pose))
    decidable = supported + seen_through
    if decidable < _LEAST_DECIDABLE * len(points) or not decidable:
        return 0.0
    return float(seen_through / decidable)


@kernel
def _compare_kernel(
    surface: PointMap, views: Views, points: Points, pose: NDArray[np.float64]
) -> tuple[int, int]:
    c, s = math.cos(pose[2]), math.sin(pose[2])
    found = np.empty(3)
    supported, contradicted = 0, 0
    for i in range(points.shape[0]):
        x = pose[0] + c * points[i, 0] - s * points[i, 1]
        y = pose[1] + s * points[i, 0] + c * points[i, 1]
        nx = c * points[i, 2] - s * points[i, 3]
        ny = s * points[i, 2] + c * points[i, 3]
        if surface_near(surface, x, y, nx, ny, surface.cell_m, found):
            supported += 1
            continue
        for k in range(views.ranges.shape[0]):
            if _sees_through(views, k, x, y):
                contradicted += 1
                break
    return supported, contradicted


@kernel(allocates=False)
def _sees_through(views: Views, k: int, x: float, y: float) -> bool:
    """Whether the three beams of view k around a point pass it by."""
    sensor = views.sensors[k]
    dx, dy = x - sensor[0], y - sensor[1]
    away = math.sqrt(dx * dx + dy * dy)
    increment, count = sensor[4], int(sensor[5])
    turn = math.copysign(1.0, increment) * (math.atan2(dy, dx) - sensor[2] - sensor[3])
    turn -= math.tau * math.floor(turn / math.tau)
    beam = int(turn / abs(increment) + 0.5)
    least = away * (1.0 + _MARGIN_SHARE) + _MARGIN_M
    for j in range(beam - 1, beam + 2):
        # A beam that is missing, or without an echo, compares as false.
        if not (0 <= j < count and views.ranges[k, j] > least):
            return False
    return True
