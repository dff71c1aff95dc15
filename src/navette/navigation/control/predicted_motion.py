"""Predict how the robot returns to its path and follows it."""

import math

import numpy as np
from numpy.typing import NDArray

from navette.navigation.control.path_pieces import DrivePiece
from navette.navigation.control.piece_progress import PathPoint

Array = NDArray[np.float64]


class PredictedMotion:
    """Poses along one piece, from the robot's own offset and heading on."""

    def __init__(self, piece: DrivePiece) -> None:
        self._piece = piece
        self._samples = np.array((piece.x, piece.y, piece.heading)).T

    def poses(self, at: PathPoint, ahead_m: float, merge_m: float) -> Array:
        """Return poses (N, 3) x, y, yaw ahead of the robot.

        The offset e from the path continues along the robot's heading ψ and vanishes
        over ``merge_m`` (L): e(d) = (e₀ + (tan ψ + 2 e₀ / L) d) (1 − d / L)².
        """
        piece = self._piece
        first = min(at.sample + 1, len(piece.s) - 1)
        last = piece.index_at(at.s + ahead_m) + 1
        on_path = self._samples[first : max(last, first + 1)]
        d = np.array(piece.s[first : max(last, first + 1)]) - at.s
        slope = math.tan(max(-1.0, min(1.0, at.heading_error)))
        growth = slope + 2 * at.cross_track / merge_m
        left = np.maximum(0.0, 1 - d / merge_m)
        offset = (at.cross_track + growth * d) * left**2
        change = growth * left**2 - 2 / merge_m * (at.cross_track + growth * d) * left
        heading = on_path[:, 2]
        yaw = heading + np.arctan(change)
        if piece.direction < 0:
            yaw = yaw + math.pi
        x = on_path[:, 0] - np.sin(heading) * offset
        y = on_path[:, 1] + np.cos(heading) * offset
        return np.column_stack([x, y, yaw])
