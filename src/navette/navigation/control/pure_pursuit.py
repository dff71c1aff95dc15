"""Regulated pure pursuit: steer an arc through a carrot on the path.

Coulter 1992, "Implementation of the Pure Pursuit Path Tracking Algorithm";
Macenski et al. 2023, "Regulated Pure Pursuit for Robot Path Tracking".
"""

import math
from dataclasses import dataclass

from navette.geometry import Pose2
from navette.navigation.control.methods import CONTROLLERS
from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_pieces import SAMPLE_M, DrivePiece
from navette.navigation.control.piece_progress import PathPoint


@CONTROLLERS.register("pure_pursuit")
@dataclass(frozen=True)
class PurePursuit:
    """Pure pursuit with a lookahead that adapts to bends and speed."""

    Params = ControlParams
    params: ControlParams

    def reset(self) -> None:
        """Do nothing: pure pursuit is stateless."""

    def curvature(
        self, piece: DrivePiece, at: PathPoint, pose: Pose2, speed: float
    ) -> float:
        """Return the curvature (1/m) to steer; left is positive driving forward.

        The carrot (x, y) in the robot's frame lies on the circle through the robot
        that is tangent to its heading: κ = 2 y / (x² + y²) (Coulter, eq. 1). With the
        carrot behind the robot, the same circle is driven in reverse.
        """
        ahead = self.carrot_distance(piece, at, speed)
        px, py = piece.point_at(max(0.0, at.s) + ahead)
        dx, dy = px - pose.x, py - pose.y
        left = math.cos(pose.yaw) * dy - math.sin(pose.yaw) * dx
        return 2 * left / max(dx * dx + dy * dy, 1e-6)

    def carrot_distance(self, piece: DrivePiece, at: PathPoint, speed: float) -> float:
        """Return the longest lookahead whose chord stays within the path tolerance.

        A path that turns by ψ over the length L deviates from its chord by at most
        about L·ψ/4. A fixed lookahead of a metre would cut a corner that the planner
        placed a few decimetres from a wall.
        """
        params = self.params
        longest = max(params.lookahead_m, params.lookahead_time_s * abs(speed))
        i = at.sample
        last = len(piece.s) - 1
        start_s, start_turn = piece.s[i], piece.winding[i]
        ahead = params.lookahead_min_m
        for k in range(i + max(1, int(ahead / SAMPLE_M)), last + 1):
            length = piece.s[k] - start_s
            turned = piece.winding[k] - start_turn
            if length > longest or length * turned > 4 * params.path_tolerance_m:
                return max(ahead, params.lookahead_min_m)
            ahead = length
        # The piece ends within the lookahead: aim at its straight continuation.
        turned = piece.winding[last] - start_turn
        return longest if longest * turned <= 4 * params.path_tolerance_m else ahead
