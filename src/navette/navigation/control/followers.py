"""The controllers by name, and what every controller offers."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from navette.navigation.control.command_follower import CommandFollower
from navette.navigation.control.limits import SpeedCap
from navette.navigation.control.methods import CONTROLLERS
from navette.navigation.control.omni_tracking import OmniTracking
from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_follower import PathFollower
from navette.navigation.control.records import FollowerInputs, FollowerOutput
from navette.navigation.control.states import ControlState
from navette.navigation.grids import NONE_UNSEEN

__all__ = ["Follower", "OmniTracking", "make_follower"]


class Follower(Protocol):
    """A controller: a path and obstacles in, a command at every step out."""

    @property
    def has_path(self) -> bool:
        """Whether a path is being followed."""

    @property
    def obstacle_reach_m(self) -> float:
        """Distance around the robot within which obstacles matter."""

    @property
    def unseen_reach_m(self) -> float:
        """Distance around the robot within which unseen space matters."""

    def reset(self, rest: ControlState = ...) -> None:
        """Drop the path and stop at once; ``rest`` is the state to report."""

    def set_path(self, poses: NDArray[np.float64]) -> None:
        """Replace the path by (N, 3) x, y, yaw (m, rad, map); an empty one stops.

        Raises:
            InvalidValueError: not (N, 3) or not finite; the follower is then reset.
        """

    def set_obstacles(
        self,
        points: NDArray[np.float64],
        half_cell: float,
        unseen: NDArray[np.float64] = NONE_UNSEEN,
    ) -> None:
        """Store the values of :class:`navette.navigation.grids.Obstacles`."""

    def set_moving(self, discs: NDArray[np.float64]) -> None:
        """Store moving obstacles (M, 5) x, y, vx, vy, radius; map, now."""

    def pause(self) -> None:
        """Continue later from the robot's motion then, not from the last command."""

    def limit_speed(self, limits: SpeedCap) -> None:
        """Drive no faster than these limits, from the next step on."""

    def step(self, inputs: FollowerInputs, dt: float) -> FollowerOutput:
        """Return the command for the next ``dt`` seconds."""


def make_follower(params: ControlParams) -> Follower:
    """Return the controller of ``params.method``."""
    method = CONTROLLERS.load(params.method)
    if method.entry == "command":
        return CommandFollower(params, method.make(params), method.name)
    if method.entry == "curvature":
        return PathFollower(params)
    follower: Follower = method.make(params)
    return follower
