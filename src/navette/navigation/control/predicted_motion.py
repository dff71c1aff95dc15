"""Predict how the robot returns to its path and follows it."""

import math

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.control.path_pieces import DrivePiece
from navette.navigation.control.piece_progress import PathPoint

Array = NDArray[np.float64]


class PredictedMotion:
    """Poses along one piece, from the robot's own offset and heading on."""

    def __init__(self, piece: DrivePiece) -> None:
        self._piece = piece
        heading = np.array(piece.heading)
        self._samples = np.array(
            (piece.s, piece.x, piece.y, heading, np.cos(heading), np.sin(heading))
        )

    def poses(self, at: PathPoint, ahead_m: float, merge_m: float) -> Array:
        """Return poses (N, 3) x, y, yaw ahead of the robot.

        The offset e from the path continues along the robot's heading ψ and vanishes
        over ``merge_m`` (L): e(d) = (e₀ + (tan ψ + 2 e₀ / L) d) (1 − d / L)².
        """
        piece = self._piece
        first = min(at.sample + 1, len(piece.s) - 1)
        last = max(piece.index_at(at.s + ahead_m), first) + 1
        slope = math.tan(max(-1.0, min(1.0, at.heading_error)))
        growth = slope + 2 * at.cross_track / merge_m
        poses = np.empty((last - first, 3))
        _fill(self._samples, first, at.s, at.cross_track, growth, merge_m, poses)
        back = math.pi if piece.direction < 0 else 0.0
        heading = self._samples[3, first:last]
        poses[:, 2] = heading + np.arctan(poses[:, 2]) + back
        return poses


@kernel(allocates=False)
def _fill(
    samples: Array,
    first: int,
    s: float,
    cross_track: float,
    growth: float,
    merge_m: float,
    poses: Array,
) -> None:
    """Write x, y, and the change of the offset per metre.

    ``samples`` (6, N): arc length, x, y, heading with cosine and sine.
    """
    for k in range(poses.shape[0]):
        i = first + k
        d = samples[0, i] - s
        left, linear = max(0.0, 1 - d / merge_m), cross_track + growth * d
        offset = linear * (left * left)
        poses[k, 0] = samples[1, i] - samples[5, i] * offset
        poses[k, 1] = samples[2, i] + samples[4, i] * offset
        poses[k, 2] = growth * (left * left) - 2 / merge_m * linear * left
