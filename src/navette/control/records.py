"""What goes into and comes out of the controller's steps."""

import math
from dataclasses import dataclass
from typing import NamedTuple

from navette.control.command_gate import FRESH, InputAges
from navette.control.limits import Command
from navette.control.states import ControlState
from navette.geometry import Pose2


@dataclass(frozen=True)
class FollowerInputs:
    """What one step sees: pose of the base in the map, motion (m/s, rad/s), ages."""

    pose: Pose2
    speed: float
    turn_rate: float
    ages: InputAges = FRESH

    @property
    def finite(self) -> bool:
        """Whether every number can be computed with."""
        return all(map(math.isfinite, (*self.pose, self.speed, self.turn_rate)))


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
