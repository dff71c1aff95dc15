"""Velocity, acceleration, wheel-speed and curvature limits of the drives."""

import math
from typing import NamedTuple

from navette.navigation.control.params import ControlParams


class VelocityCommand(NamedTuple):
    """Commanded forward speed (m/s), turn rate (rad/s) and speed to the left (m/s)."""

    speed: float
    turn_rate: float
    side: float = 0.0

    @property
    def planar_speed(self) -> float:
        """Magnitude of the velocity, m/s."""
        return math.hypot(self.speed, self.side)

    def scaled(self, share: float) -> "VelocityCommand":
        """Return a share of the command: the same arc, driven slower."""
        return VelocityCommand(
            self.speed * share, self.turn_rate * share, self.side * share
        )


STOP = VelocityCommand(0.0, 0.0)


class SpeedCap(NamedTuple):
    """Temporary limits (m/s) of the speed forward or sideways, and in reverse."""

    forward: float
    reverse: float

    def applied_to(self, command: VelocityCommand) -> VelocityCommand:
        """Return the command, slowed down on its arc if it exceeds a limit."""
        limit = self.reverse if command.speed < 0 else self.forward
        planar = command.planar_speed
        return command if planar <= limit else command.scaled(limit / planar)

    @classmethod
    def percentage(cls, percent: float, params: ControlParams) -> "SpeedCap":
        """Return a share of the speeds on a free path."""
        share = percent / 100
        return cls(share * params.cruise_speed_mps, share * params.reverse_speed_mps)


NO_CAP = SpeedCap(math.inf, math.inf)


def clamp(command: VelocityCommand, params: ControlParams) -> VelocityCommand:
    """Return the nearest allowed command of the same curvature.

    A wheel's rim moves at ``v ± ω·b/2``. Where one would be too fast, v and ω shrink by
    the same factor, so that the robot stays on its arc. An Ackermann drive turns less
    where the arc is too sharp.
    """
    command = steerable(command, params)
    v, omega, side = command
    planar = command.planar_speed
    rim = abs(v) + abs(side) + abs(omega) * params.wheel_separation_m / 2
    wheel = params.max_wheel_speed_mps
    sideways = params.max_side_speed_mps
    factor = min(
        1.0,
        params.max_speed_mps / planar if planar else 1.0,
        params.max_turn_rate_radps / abs(omega) if omega else 1.0,
        sideways / abs(side) if side else 1.0,
        wheel / rim if wheel and rim else 1.0,
    )
    return command.scaled(factor)


def steerable(command: VelocityCommand, params: ControlParams) -> VelocityCommand:
    """Return the command with the turn rate that the steering reaches at its speed."""
    radius = params.min_turning_radius_m
    most = abs(command.speed) / radius if radius else math.inf
    if abs(command.turn_rate) <= most:
        return command
    return command._replace(turn_rate=math.copysign(most, command.turn_rate))


def approach(
    last: VelocityCommand, target: VelocityCommand, params: ControlParams, dt: float
) -> VelocityCommand:
    """Step from the last command towards ``target`` within the accelerations."""
    target = clamp(target, params)
    v = _ramp(last.speed, target.speed, params, dt)
    side = _ramp(last.side, target.side, params, dt)
    step = params.turn_acceleration_radps2 * dt
    omega = last.turn_rate + min(step, max(-step, target.turn_rate - last.turn_rate))
    return clamp(VelocityCommand(v, omega, side), params)


def brake(last: VelocityCommand, params: ControlParams, dt: float) -> VelocityCommand:
    """Slow down on the present arc: the turn rate falls in proportion to the speed."""
    speed = last.planar_speed
    if speed == 0.0:
        step = params.turn_acceleration_radps2 * dt
        left = max(0.0, abs(last.turn_rate) - step)
        return clamp(VelocityCommand(0.0, math.copysign(left, last.turn_rate)), params)
    return clamp(last.scaled(_ramp(speed, 0.0, params, dt) / speed), params)


def _ramp(last: float, target: float, params: ControlParams, dt: float) -> float:
    if last * target < 0:
        target = 0.0  # stop first: braking and starting have different limits
    growing = abs(target) > abs(last)
    rate = params.acceleration_mps2 if growing else params.deceleration_mps2
    step = rate * dt
    return last + min(step, max(-step, target - last))
