"""Turn in place: accelerate, hold, brake to stop at the heading."""

import math
from collections.abc import Callable

from navette.geometry import Pose2, angle_difference, wrap_angle
from navette.navigation.control.limits import STOP, Command, MotionLimits
from navette.navigation.control.records import FollowerInputs, Wanted
from navette.navigation.control.states import ControlState

STANDSTILL_MPS = 0.1  # slower than this the robot may turn in place or reverse
_DONE_RADPS = 0.2  # a turn is done when it has slowed down to this
_BRAKE_SHARE = 0.7  # of the turn acceleration, planned for braking
_SETTLE_S = 0.3
_DELAY_S = 0.1  # the drive answers about this late


def turn_rate(error: float, rate: float, max_rate: float, acceleration: float) -> float:
    """Turn rate (rad/s) that takes the heading ``error`` (rad, signed) to zero.

    ``|ω| ≤ sqrt(2 α |e|)``, the rate from which braking at α ends at the heading. The
    error is taken as it will be when the command acts, and the root's infinite slope
    at zero is cut off by ``e / 0.3 s``; both keep a lagging drive from overshooting.
    """
    ahead = error - rate * _DELAY_S
    if ahead * error < 0:
        return 0.0
    size = min(
        math.sqrt(2 * _BRAKE_SHARE * acceleration * abs(ahead)), abs(error) / _SETTLE_S
    )
    return math.copysign(min(size, max_rate), error)


def remaining_turn(target: float, yaw: float, direction: int) -> float:
    """Signed turn (rad) left from ``yaw`` to ``target`` in ``direction`` (+1 left).

    Half a radian too far counts as an overshoot to be turned back, not as a lap.
    """
    error = wrap_angle(target - yaw)
    if error * direction < -0.5:
        error += direction * math.tau
    return error


def choose_direction(target: float, yaw: float, rate: float, planned: float) -> int:
    """+1 (left) or −1 (right) for a turn from ``yaw`` to ``target``, rad.

    The short way, except that a turn ``planned`` (signed, 0: no plan) the long way
    keeps to its plan, and one of about half a lap keeps to the present ``rate``:
    replanning must not swing the robot to and fro.
    """
    error = angle_difference(target, yaw)
    if planned and error * planned < 0 and math.tau - abs(error) < abs(planned) + 0.5:
        return 1 if planned > 0 else -1
    if not planned and abs(error) > math.pi - 0.5 and abs(rate) > 0.1:
        return 1 if rate > 0 else -1
    return 1 if error >= 0 else -1


class TurnInPlace:
    """One turn to a heading, in a direction in which the body's sweep is free.

    Args:
        target: heading to reach, rad, map.
        planned: the turn as planned (rad, signed), 0 if only the target counts.
        tolerance: heading error (rad) that counts as done.
        is_free: whether the body may turn by so much (rad, signed) at a pose.
        either_way: turn the other way round where the preferred one is not free.
    """

    def __init__(
        self,
        target: float,
        planned: float,
        *,
        tolerance: float,
        limits: MotionLimits,
        is_free: Callable[[Pose2, float], bool],
        either_way: bool = True,
    ) -> None:
        self._target = target
        self._planned = planned
        self._tolerance = tolerance
        self._limits = limits
        self._is_free = is_free
        self.either_way = either_way
        self._direction = 0

    def step(self, inputs: FollowerInputs, turn_gain: float) -> Wanted | None:
        """The turn's next command, or None when the heading is reached.

        ``turn_gain`` is the measured share of a commanded turn rate.
        """
        error = angle_difference(self._target, inputs.pose.yaw)
        settled = abs(inputs.turn_rate) < _DONE_RADPS
        if abs(error) <= self._tolerance and settled:
            return None
        if abs(inputs.speed) > STANDSTILL_MPS:
            return Wanted(STOP, ControlState.TURNING, brakes=True)
        if self._direction == 0 and not self._choose(inputs):
            return Wanted(STOP, ControlState.BLOCKED, brakes=True)
        error = remaining_turn(self._target, inputs.pose.yaw, self._direction)
        rate = turn_rate(
            error,
            inputs.turn_rate,
            self._limits.turn_rate,
            self._limits.turn_acceleration,
        )
        return Wanted(Command(0.0, rate / turn_gain), ControlState.TURNING)

    def reconsider(self) -> None:
        """The chosen way turned out blocked: choose again at the next step."""
        self._direction = 0

    def _choose(self, inputs: FollowerInputs) -> bool:
        """Pick a direction whose sweep is free, the preferred one first."""
        yaw = inputs.pose.yaw
        preferred = choose_direction(self._target, yaw, inputs.turn_rate, self._planned)
        for direction in (preferred, -preferred)[: 2 if self.either_way else 1]:
            turn = remaining_turn(self._target, yaw, direction)
            if direction * turn < 0:
                turn += direction * math.tau
            if self._is_free(inputs.pose, turn):
                self._direction = direction
                return True
        return False
