"""What goes into and comes out of the controller's steps."""

import math
from dataclasses import dataclass
from typing import NamedTuple

from navette.geometry import Pose2
from navette.navigation.control.command_gate import FRESH, InputAges
from navette.navigation.control.limits import Command
from navette.navigation.control.states import ControlState

FARTHEST_M = 1e8  # from the map's origin; UTM northings reach 1e7
_FASTEST = 1e3  # m/s, rad/s
UNKNOWN_POSE = Pose2(math.nan, math.nan, math.nan)


@dataclass(frozen=True)
class FollowerInputs:
    """What one step sees: pose of the base in the map, motion (m/s, rad/s), ages.

    A robot whose place is not known (:data:`UNKNOWN_POSE`) is not moved.
    """

    pose: Pose2
    speed: float
    turn_rate: float
    ages: InputAges = FRESH

    @property
    def plausible(self) -> bool:
        """Whether every number is finite and can be that of a robot."""
        return (
            math.hypot(self.pose.x, self.pose.y) <= FARTHEST_M
            and abs(self.pose.yaw) <= FARTHEST_M
            and math.hypot(self.speed, self.turn_rate) <= _FASTEST
        )


class FollowerOutput(NamedTuple):
    """The command with its state; errors are those of the robot on its piece."""

    command: Command
    state: ControlState
    cross_track_m: float
    heading_error_rad: float
    distance_left_m: float
    clearance_m: float


class Wanted(NamedTuple):
    """What a piece asks for, before accelerations and obstacles."""

    command: Command
    state: ControlState
    brakes: bool = False  # slow down on the present arc instead of steering
