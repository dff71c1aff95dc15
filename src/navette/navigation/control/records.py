"""Inputs and outputs of a controller step."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry import Pose2
from navette.navigation.control.command_gate import FRESH, InputAges
from navette.navigation.control.limits import VelocityCommand
from navette.navigation.control.states import ControlState, LimitedBy

FARTHEST_M = 1e8  # from the map's origin; UTM northings reach 1e7
_FASTEST = 1e3  # m/s, rad/s
UNKNOWN_POSE = Pose2(math.nan, math.nan, math.nan)


def check_poses(poses: NDArray[np.float64]) -> None:
    """Raise InvalidValueError unless the poses are (N, 3), finite, and not too far."""
    if poses.ndim != 2 or poses.shape[1] != 3 or not np.isfinite(poses).all():
        raise InvalidValueError(
            f"path of shape {poses.shape}: expected finite poses (N, 3) x, y, yaw"
        )
    if np.abs(poses[:, :2]).max(initial=0.0) > FARTHEST_M:
        raise InvalidValueError(
            f"path of {len(poses)} poses: expected all within {FARTHEST_M:g} m of the "
            "map's origin"
        )


@dataclass(frozen=True)
class FollowerInputs:
    """Pose of the base in the map, motion (m/s, rad/s), and ages of the inputs.

    ``side_speed`` is the speed to the left, m/s.

    With :data:`UNKNOWN_POSE` the robot stays stopped.
    """

    pose: Pose2
    speed: float
    turn_rate: float
    ages: InputAges = FRESH
    side_speed: float = 0.0

    @property
    def plausible(self) -> bool:
        """Whether all values are finite and physically possible."""
        return (
            math.hypot(self.pose.x, self.pose.y) <= FARTHEST_M
            and abs(self.pose.yaw) <= FARTHEST_M
            and math.hypot(self.speed, self.turn_rate, self.side_speed) <= _FASTEST
        )


class FollowerOutput(NamedTuple):
    """Command and state, with the tracking errors on the current piece."""

    command: VelocityCommand
    state: ControlState
    cross_track_m: float
    heading_error_rad: float
    distance_left_m: float
    clearance_m: float
    collision_scale: float  # share of the command that the obstacles allow
    limited_by: LimitedBy = LimitedBy.NONE


class Rollouts(NamedTuple):
    """Motions that a controller compared: positions (K, T, 2) in the map, cost (K,).

    The cheapest comes first.
    """

    positions: NDArray[np.float64]
    costs: NDArray[np.float64]


PAUSED = FollowerOutput(
    VelocityCommand(0.0, 0.0),
    ControlState.PAUSED,
    cross_track_m=math.nan,
    heading_error_rad=math.nan,
    distance_left_m=math.nan,
    clearance_m=math.nan,
    collision_scale=1.0,
)
"""Output while another source commands."""


class StepDecision(NamedTuple):
    """Command of a piece before acceleration limits and obstacles are applied."""

    command: VelocityCommand
    state: ControlState
    brakes: bool = False  # slow down on the present arc instead of steering
    limited_by: LimitedBy = LimitedBy.NONE
