"""Turn in place: accelerate, hold, brake to stop at the heading."""

import math

from navette.geometry import angle_difference, wrap_angle
from navette.navigation.control.controller_parts import TurnParts
from navette.navigation.control.limits import STOP, VelocityCommand
from navette.navigation.control.params import ControlParams
from navette.navigation.control.records import FollowerInputs, StepDecision
from navette.navigation.control.states import ControlState

STANDSTILL_MPS = 0.1  # slower than this the robot may turn in place or reverse
_DONE_RADPS = 0.2  # a turn is complete below this rate
_BRAKE_SHARE = 0.7  # of the turn acceleration, planned for braking
_SETTLE_S = 0.3
_DELAY_S = 0.1  # delay of the drive


def turn_rate(error: float, rate: float, params: ControlParams) -> float:
    """Return the turn rate (rad/s) that reduces the heading ``error`` (rad) to zero.

    ``|ω| ≤ sqrt(2 α |e|)`` is the rate from which braking at α ends at the heading. The
    error is predicted to when the command acts, and the root's infinite slope at zero
    is limited by ``e / 0.3 s``; both keep a lagging drive from overshooting.
    """
    ahead = error - rate * _DELAY_S
    if ahead * error < 0:
        return 0.0
    size = min(
        math.sqrt(2 * _BRAKE_SHARE * params.turn_acceleration_radps2 * abs(ahead)),
        abs(error) / _SETTLE_S,
    )
    return math.copysign(min(size, params.max_turn_rate_radps), error)


def remaining_turn(target: float, yaw: float, direction: int) -> float:
    """Return the signed turn (rad) to ``target`` in ``direction`` (+1 left).

    Up to half a radian beyond the target counts as overshoot, to be turned back.
    """
    error = wrap_angle(target - yaw)
    if error * direction < -0.5:
        error += direction * math.tau
    return error


def choose_direction(target: float, yaw: float, rate: float, planned: float) -> int:
    """Return +1 (left) or −1 (right) for a turn from ``yaw`` to ``target``, rad.

    The shorter direction, with two exceptions that keep replanning from swinging the
    robot back and forth: a turn ``planned`` (signed, 0: no plan) in the longer
    direction keeps it, and a turn of about 180° keeps the direction of ``rate``.
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
        planned: the planned turn (rad, signed), 0 if only the target matters.
        parts: parameters and shared parts of the controller.
        both_directions: turn in the other direction if the preferred one is blocked.
    """

    def __init__(
        self,
        target: float,
        planned: float,
        parts: TurnParts,
        *,
        both_directions: bool = True,
    ) -> None:
        self._target = target
        self._planned = planned
        self._parts = parts
        self.both_directions = both_directions
        self._direction = 0

    def step(self, inputs: FollowerInputs) -> StepDecision | None:
        """Return the next command of the turn, or None when the heading is reached."""
        params = self._parts.params
        error = angle_difference(self._target, inputs.pose.yaw)
        settled = abs(inputs.turn_rate) < _DONE_RADPS
        if abs(error) <= params.turn_tolerance_rad and settled:
            return None
        if abs(inputs.speed) > STANDSTILL_MPS:
            return StepDecision(STOP, ControlState.TURNING, brakes=True)
        if self._direction == 0 and not self._choose(inputs):
            return StepDecision(STOP, ControlState.BLOCKED, brakes=True)
        error = remaining_turn(self._target, inputs.pose.yaw, self._direction)
        rate = turn_rate(error, inputs.turn_rate, params)
        command = VelocityCommand(0.0, rate / self._parts.turn_gain.value)
        return StepDecision(command, ControlState.TURNING)

    def reconsider(self) -> None:
        """Choose the direction again at the next step: the chosen one is blocked."""
        self._direction = 0

    def _choose(self, inputs: FollowerInputs) -> bool:
        """Choose a direction whose sweep is free, the preferred one first."""
        yaw = inputs.pose.yaw
        preferred = choose_direction(self._target, yaw, inputs.turn_rate, self._planned)
        for direction in (preferred, -preferred)[: 2 if self.both_directions else 1]:
            turn = remaining_turn(self._target, yaw, direction)
            if direction * turn < 0:
                turn += direction * math.tau
            if self._parts.collision.turn_is_free(inputs.pose, turn):
                self._direction = direction
                return True
        return False
