"""Call every kernel of SLAM once, so that its machine code is stored."""

import math

import numpy as np

from navette.geometry import Pose2
from navette.navigation.grids import PlanarScan
from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.slam import Slam

_BEAMS, _HALF_X, _HALF_Y = 180, 6.0, 4.0
_STEP_M, _STEPS = 0.5, 14


def warm_up() -> None:
    """Map a room of 12 m × 8 m in which the robot drives ahead."""
    slam = Slam(SlamParams())
    for k in range(_STEPS):
        true_x = _STEP_M * k - 3.0
        # Odometry with an error that requires a search.
        odometry = Pose2(1.1 * _STEP_M * k, 0.0, 0.0)
        slam.add(k * 100_000_000, _room_scan(true_x), odometry)
    slam.refine()
    slam.occupancy()


def _room_scan(x: float) -> PlanarScan:
    angles = np.linspace(-math.pi, math.pi, _BEAMS, endpoint=False)
    c, s = np.cos(angles), np.sin(angles)
    with np.errstate(divide="ignore"):
        to_end = np.where(c > 0, _HALF_X - x, -_HALF_X - x) / c
        to_side = np.where(s > 0, _HALF_Y, -_HALF_Y) / s
    ranges = np.minimum(np.abs(to_end), np.abs(to_side)).astype(np.float32)
    return PlanarScan(ranges, -math.pi, math.tau / _BEAMS, 0.1, 30.0)
