"""PID on the cross-track error, with the heading error as its derivative."""

import math

from navette.geometry import Pose2
from navette.navigation.control.methods import CONTROLLERS
from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_pieces import DrivePiece
from navette.navigation.control.piece_progress import PathPoint

_PREVIEW_S = 0.15  # delay of the drive: feed the curvature forward
_MAX_CURVATURE = 4.0  # 1/m
_MAX_INTEGRAL = 0.5  # 1/m, contribution of the integral


@CONTROLLERS.register("cross_track_pid")
class CrossTrackPid:
    """Steer ``κ = κ_path − kp e − ki ∫e ds − kd sin ψ``.

    All gains are per metre, not per second: since de/ds = sin ψ, the heading error ψ is
    the derivative term, and the gains hold at every speed. The error obeys
    e″ + kd e′ + kp e = 0, which is critically damped at kd² = 4 kp.
    """

    Params = ControlParams

    def __init__(self, params: ControlParams) -> None:
        self._params = params
        self._integral = 0.0
        self._s: float | None = None

    def reset(self) -> None:
        """Clear the integral."""
        self._integral = 0.0
        self._s = None

    def curvature(
        self, piece: DrivePiece, at: PathPoint, pose: Pose2, speed: float
    ) -> float:
        """Return the curvature (1/m) to steer; left is positive driving forward."""
        params = self._params
        moved = 0.0 if self._s is None else max(0.0, at.s - self._s)
        self._s = at.s
        integral = self._integral + params.pid_ki_per_m3 * at.cross_track * moved
        self._integral = min(_MAX_INTEGRAL, max(-_MAX_INTEGRAL, integral))
        preview = piece.index_at(at.s + _PREVIEW_S * abs(speed))
        kappa = (
            piece.curvature[preview]
            - params.pid_kp_per_m2 * at.cross_track
            - self._integral
            - params.pid_kd_per_m * math.sin(at.heading_error)
        )
        kappa = min(_MAX_CURVATURE, max(-_MAX_CURVATURE, kappa))
        # Along the travel, left is left in both directions. In reverse v < 0 and the
        # turn rate is v κ, so the robot's curvature has the opposite sign.
        return kappa * piece.direction
