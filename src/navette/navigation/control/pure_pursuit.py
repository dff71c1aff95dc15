"""Regulated pure pursuit: steer an arc through a carrot on the path.

Coulter 1992, "Implementation of the Pure Pursuit Path Tracking Algorithm";
Macenski et al. 2023, "Regulated Pure Pursuit for Robot Path Tracking".
"""

import math
from dataclasses import dataclass

from navette.geometry import Pose2
from navette.navigation.control.path_pieces import SAMPLE_M, DrivePiece
from navette.navigation.control.path_progress import PathPoint


@dataclass(frozen=True)
class PurePursuit:
    """Lengths in metres; ``time`` (s) lets the lookahead grow with the speed."""

    lookahead: float
    shortest: float
    time: float
    tolerance: float

    def reset(self) -> None:
        """Pure pursuit keeps no memory."""

    def curvature(
        self, piece: DrivePiece, at: PathPoint, pose: Pose2, speed: float
    ) -> float:
        """Curvature (1/m, of the robot, left positive driving forward) to steer.

        The carrot (x, y) in the robot's frame lies on the circle through the robot
        that is tangent to its heading: κ = 2 y / (x² + y²) (Coulter, eq. 1). The same
        circle is driven backwards when the carrot lies behind.
        """
        ahead = self.carrot_distance(piece, at, speed)
        px, py = piece.point_at(max(0.0, at.s) + ahead)
        dx, dy = px - pose.x, py - pose.y
        left = math.cos(pose.yaw) * dy - math.sin(pose.yaw) * dx
        return 2 * left / max(dx * dx + dy * dy, 1e-6)

    def carrot_distance(self, piece: DrivePiece, at: PathPoint, speed: float) -> float:
        """Longest lookahead whose chord stays within the tolerance of the path.

        A path that turns by ψ over the length L leaves its chord by at most about
        L·ψ/4; a fixed lookahead of a metre would cut a corner that the planner placed
        a few decimetres from a wall.
        """
        longest = max(self.lookahead, self.time * abs(speed))
        i = at.sample
        last = len(piece.s) - 1
        start_s, start_turn = piece.s[i], piece.winding[i]
        ahead = self.shortest
        for k in range(i + max(1, int(ahead / SAMPLE_M)), last + 1):
            length = piece.s[k] - start_s
            turned = piece.winding[k] - start_turn
            if length > longest or length * turned > 4 * self.tolerance:
                return max(ahead, self.shortest)
            ahead = length
        # The piece ends within reach: aim at its straight continuation.
        turned = piece.winding[last] - start_turn
        return longest if longest * turned <= 4 * self.tolerance else ahead
