"""PID on the cross-track error, with the heading error as its derivative."""

import math

from navette.geometry import Pose2
from navette.navigation.control.path_pieces import DrivePiece
from navette.navigation.control.path_progress import PathPoint

_PREVIEW_S = 0.15  # the drive answers about this late: feed the curvature forward
_MAX_CURVATURE = 4.0  # 1/m
_MAX_INTEGRAL = 0.5  # 1/m, the share of the integral


class CrossTrackPid:
    """Steers ``κ = κ_path − kp e − ki ∫e ds − kd sin ψ``.

    Everything is counted per metre, not per second: since de/ds = sin ψ, the heading
    error ψ is the derivative term, and the gains hold at every speed. The error then
    obeys e″ + kd e′ + kp e = 0: critically damped at kd² = 4 kp.
    """

    def __init__(self, kp: float, ki: float, kd: float) -> None:
        self._kp, self._ki, self._kd = kp, ki, kd
        self._share = 0.0
        self._s: float | None = None

    def reset(self) -> None:
        """Forget the integral."""
        self._share = 0.0
        self._s = None

    def curvature(
        self, piece: DrivePiece, at: PathPoint, pose: Pose2, speed: float
    ) -> float:
        """Curvature (1/m, of the robot, left positive driving forward) to steer."""
        moved = 0.0 if self._s is None else max(0.0, at.s - self._s)
        self._s = at.s
        share = self._share + self._ki * at.cross_track * moved
        self._share = min(_MAX_INTEGRAL, max(-_MAX_INTEGRAL, share))
        preview = piece.index_at(at.s + _PREVIEW_S * abs(speed))
        kappa = (
            piece.curvature[preview]
            - self._kp * at.cross_track
            - self._share
            - self._kd * math.sin(at.heading_error)
        )
        kappa = min(_MAX_CURVATURE, max(-_MAX_CURVATURE, kappa))
        # Seen along the travel left is left either way; a robot that backs up has
        # v < 0 and turns by v κ, so its curvature has the other sign.
        return kappa * piece.direction
