"""Progress of the robot along a piece, without jumps where the path crosses itself."""

import math
from typing import NamedTuple

from navette.geometry import Pose2, angle_difference
from navette.navigation.control.path_pieces import DrivePiece

_BACK_M = 0.3
_AHEAD_M = 0.8  # per tick; 2 m/s at 10 Hz is 0.2 m


class PathPoint(NamedTuple):
    """Position of the robot relative to the nearest point of its piece.

    Attributes:
        sample: index of the sample before the nearest point.
        s: arc length of the nearest point (m).
        cross_track: offset (m), positive left of the direction of travel.
        heading_error: the robot's direction of travel minus the path's (rad).
    """

    sample: int
    s: float
    cross_track: float
    heading_error: float


class PieceProgress:
    """Track the nearest point of one piece within a window of arc length."""

    def __init__(self, piece: DrivePiece, start_window_m: float) -> None:
        self.piece = piece
        self._s = 0.0
        self._ahead = start_window_m

    def update(self, pose: Pose2) -> PathPoint:
        """Return the nearest point, at most :data:`_AHEAD_M` beyond the last one."""
        piece = self.piece
        first = piece.index_at(self._s - _BACK_M)
        last = piece.index_at(self._s + self._ahead) + 1
        self._ahead = _AHEAD_M
        x, y, _ = pose
        gaps = [
            (px - x) * (px - x) + (py - y) * (py - y)
            for px, py in zip(piece.x[first:last], piece.y[first:last], strict=True)
        ]
        point = self._on_segment(first + gaps.index(min(gaps)), pose)
        self._s = min(max(point.s, 0.0), piece.length)
        return point

    def _on_segment(self, nearest: int, pose: Pose2) -> PathPoint:
        """Refine the nearest sample to a point on the segment before or after it."""
        piece = self.piece
        i = min(nearest, len(piece.x) - 2)
        along, left = self._local(i, pose)
        if along < 0 and i > 0:
            i -= 1
            along, left = self._local(i, pose)
        travel = pose.yaw if piece.direction > 0 else pose.yaw + math.pi
        error = angle_difference(travel, piece.heading[i])
        return PathPoint(i, piece.s[i] + along, left, error)

    def _local(self, i: int, pose: Pose2) -> tuple[float, float]:
        dx, dy = pose.x - self.piece.x[i], pose.y - self.piece.y[i]
        c, s = math.cos(self.piece.heading[i]), math.sin(self.piece.heading[i])
        return c * dx + s * dy, c * dy - s * dx
