"""Steering laws: the curvature along a piece of the path."""

from typing import Any, Protocol

from navette.geometry import Pose2
from navette.navigation.control.cross_track_pid import CrossTrackPid
from navette.navigation.control.methods import CONTROLLERS
from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_pieces import DrivePiece
from navette.navigation.control.piece_progress import PathPoint
from navette.navigation.control.pure_pursuit import PurePursuit
from navette.params.plugins import checked_array, own_call

__all__ = ["CrossTrackPid", "PurePursuit", "Steering", "make_steering"]


class Steering(Protocol):
    """A path-tracking method."""

    def reset(self) -> None: ...

    def curvature(
        self, piece: DrivePiece, at: PathPoint, pose: Pose2, speed: float
    ) -> float:
        """Return the curvature (1/m) to steer; left is positive driving forward."""


def make_steering(params: ControlParams) -> Steering:
    """Return the steering law of ``params.method``."""
    method = CONTROLLERS.load(params.method)
    steering: Steering = method.make(params)
    return OwnSteering(steering, method.name) if method.is_own else steering


class OwnSteering:
    """A user's steering law; its faults raise MethodFaultError."""

    def __init__(self, law: Any, name: str) -> None:
        self._law = law
        self._name = f"controller {name}: curvature(piece, at, pose, speed)"

    def reset(self) -> None:
        """Reset what the law has accumulated, if it supports that."""
        if hasattr(self._law, "reset"):
            own_call(self._name, self._law.reset)

    def curvature(
        self, piece: DrivePiece, at: PathPoint, pose: Pose2, speed: float
    ) -> float:
        """Return the curvature (1/m) to steer; left is positive driving forward."""
        value = own_call(self._name, self._law.curvature, piece, at, pose, speed)
        expected = "a curvature in 1/m"
        return float(checked_array(self._name, value, expected, lambda s: s == ()))
