"""Velocity, acceleration and wheel-speed limits of a differential drive."""

import math
from dataclasses import dataclass
from typing import NamedTuple


class Command(NamedTuple):
    """What the robot is told: forward speed (m/s) and turn rate (rad/s)."""

    speed: float
    turn_rate: float


STOP = Command(0.0, 0.0)


@dataclass(frozen=True)
class MotionLimits:
    """Bounds on commands, SI. A wheel separation or speed of 0 lifts that bound."""

    speed: float
    turn_rate: float
    acceleration: float
    deceleration: float
    turn_acceleration: float
    wheel_separation: float = 0.0
    wheel_speed: float = 0.0

    def clamp(self, command: Command) -> Command:
        """The nearest allowed command of the same curvature.

        A wheel's rim moves at ``v ± ω·b/2``; where one would be too fast, both v and
        ω shrink by the same factor, so that the robot keeps to its arc.
        """
        v, omega = command
        rim = abs(v) + abs(omega) * self.wheel_separation / 2
        factor = min(
            1.0,
            self.speed / abs(v) if v else 1.0,
            self.turn_rate / abs(omega) if omega else 1.0,
            self.wheel_speed / rim if self.wheel_speed and rim else 1.0,
        )
        return Command(v * factor, omega * factor)

    def towards(self, last: Command, wanted: Command, dt: float) -> Command:
        """From the last command towards the wanted one within the accelerations."""
        wanted = self.clamp(wanted)
        v = ramp(last.speed, wanted.speed, self.acceleration, self.deceleration, dt)
        step = self.turn_acceleration * dt
        omega = last.turn_rate + min(
            step, max(-step, wanted.turn_rate - last.turn_rate)
        )
        return self.clamp(Command(v, omega))

    def brake(self, last: Command, dt: float) -> Command:
        """Slow down on the present arc: turn rate falls in step with the speed."""
        v = ramp(last.speed, 0.0, self.acceleration, self.deceleration, dt)
        if last.speed == 0.0:
            step = self.turn_acceleration * dt
            left = max(0.0, abs(last.turn_rate) - step)
            return self.clamp(Command(0.0, math.copysign(left, last.turn_rate)))
        return self.clamp(Command(v, last.turn_rate * v / last.speed))


def ramp(last: float, wanted: float, rise: float, fall: float, dt: float) -> float:
    """``wanted``, or as near as ``rise`` (away from 0) and ``fall`` (to 0) allow."""
    if last * wanted < 0:
        wanted = 0.0  # through standstill first: braking and starting differ
    growing = abs(wanted) > abs(last)
    step = (rise if growing else fall) * dt
    return last + min(step, max(-step, wanted - last))
