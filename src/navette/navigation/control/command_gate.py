"""The last check before the robot: refuse invalid commands and stale inputs."""

import math
from dataclasses import dataclass

from navette.navigation.control.limits import VelocityCommand
from navette.navigation.control.params import ControlParams
from navette.navigation.control.states import ControlState

_ROUNDING = 1e-6
# Share of the timeout from which an input is late, and of the speed at the timeout.
_LATE = 0.4
_SLOWEST = 1 / 3


@dataclass(frozen=True)
class InputAges:
    """Seconds since each input last arrived; ``inf``: never.

    The timeouts follow the measured rate of the input; 0: those of the parameters.
    """

    odometry_s: float = 0.0
    costmap_s: float = 0.0
    planner_s: float = 0.0
    odometry_timeout_s: float = 0.0
    costmap_timeout_s: float = 0.0


FRESH = InputAges()


@dataclass(frozen=True)
class CommandGate:
    """Refuse commands that are not finite or over a limit, and stale inputs.

    The gate repairs nothing: a command over the limits is a fault upstream, so the
    robot stops and the state names the reason.
    """

    params: ControlParams

    def stale(self, ages: InputAges) -> ControlState | None:
        """Return the state for the first input that is too old, or None.

        Written so that an age of NaN counts as stale.
        """
        params = self.params
        odometry_timeout_s, costmap_timeout_s = self._timeouts(ages)
        if not ages.odometry_s <= odometry_timeout_s:
            return ControlState.STALE_ODOMETRY
        if params.collision_check and not ages.costmap_s <= costmap_timeout_s:
            return ControlState.STALE_COSTMAP
        planner_timeout_s = params.planner_timeout_s or math.inf
        if not ages.planner_s <= planner_timeout_s:
            return ControlState.STALE_PATH
        return None

    def eased(self, command: VelocityCommand, ages: InputAges) -> VelocityCommand:
        """Return the command, slower while odometry or costmap is late.

        From 40 % of the timeout on, the limits fall linearly to a third at the timeout:
        one lost message hardly slows the robot down, and a robot without data stops
        within a short distance.
        """
        odometry_timeout_s, costmap_timeout_s = self._timeouts(ages)
        late = ages.odometry_s / odometry_timeout_s
        if self.params.collision_check:
            late = max(late, ages.costmap_s / costmap_timeout_s)
        if late <= _LATE:
            return command
        share = 1.0 - (1.0 - _SLOWEST) * (late - _LATE) / (1.0 - _LATE)
        params = self.params
        cruise = params.cruise_speed_mps
        if command.speed < 0:
            cruise = params.reverse_speed_mps
        speed = math.hypot(command.speed, command.side) / cruise
        turning = abs(command.turn_rate) / params.max_turn_rate_radps
        fastest = max(speed, turning)
        return command.scaled(share / fastest) if fastest > share else command

    def _timeouts(self, ages: InputAges) -> tuple[float, float]:
        """Return the timeouts of odometry and costmap."""
        params = self.params
        return (
            ages.odometry_timeout_s or params.odometry_timeout_s,
            ages.costmap_timeout_s or params.costmap_timeout_s,
        )

    def refusal(self, command: VelocityCommand) -> ControlState | None:
        """Return the state for a command that must not pass, or None."""
        if not all(map(math.isfinite, command)):
            return ControlState.COMMAND_NOT_FINITE
        params = self.params
        if (
            math.hypot(command.speed, command.side) > params.max_speed_mps + _ROUNDING
            or abs(command.turn_rate) > params.max_turn_rate_radps + _ROUNDING
            or abs(command.side) > params.max_side_speed_mps + _ROUNDING
            or abs(command.turn_rate) * params.min_turning_radius_m
            > abs(command.speed) + _ROUNDING
        ):
            return ControlState.COMMAND_OVER_LIMIT
        return None
