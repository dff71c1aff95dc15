"""Returns where earlier beams passed, and earlier returns where beams pass now.

A point that one scan measured and beams of another scan passed was entered or left in
between. No map is required: the other scan itself is the record of what was free.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel

Points = NDArray[np.float64]
Flags = NDArray[np.bool_]

# Beams on each side of a point that must have passed it.
_BESIDE = 2


class PlacedScan(NamedTuple):
    """A scan in the map.

    Attributes:
        ranges: (N,) float32 m, as in sensor_msgs/LaserScan.
        points: (N, 2) returns in the map, m; undefined where not ``valid``.
        valid: (N,) whether the beam has a return within the range of the tracking.
        x, y, yaw: pose of the sensor in the map.
        angle_min, angle_increment: of the beams, rad.
        range_max: largest range of the sensor, m.
        stamp_ns: of the scan.
    """

    ranges: NDArray[np.float32]
    points: Points
    valid: Flags
    x: float
    y: float
    yaw: float
    angle_min: float
    angle_increment: float
    range_max: float
    stamp_ns: int


@kernel(
    signature="Tuple((boolean[::1], float64[::1], float64[:, ::1]))(float32[::1],"
    " float64[:, ::1], float64, float64)"
)
def returns(
    ranges: NDArray[np.float32], directions: Points, least: float, most: float
) -> tuple[Flags, NDArray[np.float64], Points]:
    """Return which beams (N,) have a return, their lengths (N,), and the points (N, 2).

    Of the others length and point are 0. All in the sensor's frame, m.

    Args:
        ranges: (N,) float32, m.
        directions: (N, 2) unit vectors of the beams.
        least, most: range of the returns, exclusive, m.
    """
    count = ranges.size
    valid, away = np.empty(count, np.bool_), np.empty(count)
    points = np.empty((count, 2))
    for i in range(count):
        valid[i] = least < ranges[i] < most  # not if it is not a number
        away[i] = ranges[i] if valid[i] else 0.0
        points[i, 0] = directions[i, 0] * away[i]
        points[i, 1] = directions[i, 1] * away[i]
    return valid, away, points


def passed_by(points: Points, valid: Flags, scan: PlacedScan, margin_m: float) -> Flags:
    """Return (M,) which of the valid points (M, 2), map, the scan's beams passed.

    The nearest beam and two on each side of it must have gone ``margin_m`` farther. A
    beam without a return passed up to the sensor's range, a beam without a result (NaN,
    too near) nothing.
    """
    passed = np.zeros(len(points), np.bool_)
    if len(scan.ranges) > 2 * _BESIDE and scan.angle_increment != 0.0:
        _passed_kernel(
            points,
            valid,
            scan.ranges,
            np.array((scan.x, scan.y, scan.yaw, scan.angle_min)),
            scan.angle_increment,
            margin_m,
            scan.range_max,
            passed,
        )
    return passed


@kernel(
    allocates=False,
    signature="void(float64[:, ::1], boolean[::1], float32[::1], float64[::1], float64,"
    " float64, float64, boolean[::1])",
)
def _passed_kernel(
    points: Points,
    valid: Flags,
    ranges: NDArray[np.float32],
    sensor: NDArray[np.float64],
    increment: float,
    margin: float,
    range_max: float,
    passed: Flags,
) -> None:
    x, y, yaw, first = sensor
    count = ranges.size
    turn = abs(2.0 * math.pi / increment)
    for i in range(points.shape[0]):
        if not valid[i]:
            continue
        dx, dy = points[i, 0] - x, points[i, 1] - y
        away = math.sqrt(dx * dx + dy * dy)
        beam = (math.atan2(dy, dx) - yaw - first) / increment
        beam -= turn * math.floor((beam + 0.5) / turn)
        nearest = int(beam + 0.5)
        if nearest < _BESIDE or nearest >= count - _BESIDE:
            continue
        far = away + margin + 0.01 * away
        if far >= range_max:
            continue
        free = True
        for k in range(nearest - _BESIDE, nearest + _BESIDE + 1):
            if not ranges[k] > far:  # also not a number
                free = False
                break
        passed[i] = free
