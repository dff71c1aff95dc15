"""The last stage before the robot: what does not belong there does not pass."""

import math
from dataclasses import dataclass

from navette.navigation.control.limits import Command, MotionLimits
from navette.navigation.control.states import ControlState

_ROUNDING = 1e-6


@dataclass(frozen=True)
class InputAges:
    """Seconds since each input last arrived; ``inf``: never."""

    odometry_s: float = 0.0
    costmap_s: float = 0.0
    planner_s: float = 0.0


FRESH = InputAges()


@dataclass(frozen=True)
class CommandGate:
    """Refuses commands that are not finite or over a limit, and stale inputs.

    It does not repair: a command over the limits is a mistake upstream, and the
    robot stops, with the reason as state. A timeout of ``inf`` switches a check off.
    """

    limits: MotionLimits
    odometry_timeout: float
    costmap_timeout: float
    planner_timeout: float

    def stale(self, ages: InputAges) -> ControlState | None:
        """Name of the state for the first input that is too old, or None."""
        if not ages.odometry_s <= self.odometry_timeout:
            return ControlState.STALE_ODOMETRY
        if not ages.costmap_s <= self.costmap_timeout:
            return ControlState.STALE_COSTMAP
        if not ages.planner_s <= self.planner_timeout:
            return ControlState.STALE_PATH
        return None

    def refusal(self, command: Command) -> ControlState | None:
        """Name of the state for a command that must not pass, or None."""
        if not (math.isfinite(command.speed) and math.isfinite(command.turn_rate)):
            return ControlState.COMMAND_NOT_FINITE
        if (
            abs(command.speed) > self.limits.speed + _ROUNDING
            or abs(command.turn_rate) > self.limits.turn_rate + _ROUNDING
        ):
            return ControlState.COMMAND_OVER_LIMIT
        return None
