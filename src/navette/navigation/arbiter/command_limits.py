"""Velocity commands and the last check before the wheels."""

import math
from dataclasses import dataclass
from typing import NamedTuple

_ROUNDING = 1e-6


class Velocity(NamedTuple):
    """The six numbers of a Twist: m/s and rad/s in the robot's frame."""

    vx: float = 0.0
    vy: float = 0.0
    vz: float = 0.0
    wx: float = 0.0
    wy: float = 0.0
    wz: float = 0.0

    @property
    def speed_mps(self) -> float:
        return math.hypot(self.vx, self.vy, self.vz)

    @property
    def turn_rate_radps(self) -> float:
        return math.hypot(self.wx, self.wy, self.wz)


ZERO = Velocity()


@dataclass(frozen=True)
class CommandLimits:
    """Limits of every command that reaches the wheels; ``inf``: no limit."""

    max_speed_mps: float = math.inf
    max_turn_rate_radps: float = math.inf

    def refusal(self, command: Velocity) -> str:
        """Return why a command must not pass; "" if it may."""
        if not all(map(math.isfinite, command)):
            return "command_not_finite"
        if self._excess(command) > 1 + _ROUNDING:
            return "command_over_limit"
        return ""

    def scaled(self, command: Velocity) -> Velocity:
        """Return the command within the limits, on the same arc."""
        excess = self._excess(command)
        if not excess > 1:
            return command
        return Velocity(*(value / excess for value in command))

    def _excess(self, command: Velocity) -> float:
        return max(
            command.speed_mps / self.max_speed_mps,
            command.turn_rate_radps / self.max_turn_rate_radps,
        )
