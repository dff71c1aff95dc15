# SPDX-License-Identifier: Apache-2.0
"""Motor controller: velocity commands to wheel speeds, within limits."""

import math
from dataclasses import dataclass

from navette.sim.params import CONTROL_PERIOD_S, SimParams

CONTROL_PERIOD_NS = round(CONTROL_PERIOD_S * 1e9)


@dataclass(frozen=True)
class BodySpeed:
    """Forward speed (m/s) and yaw rate (rad/s) of the base."""

    linear: float = 0.0
    angular: float = 0.0


_STOP = BodySpeed()


class SpeedRamp:
    """Follows the newest command within speed and acceleration limits.

    Without a newer command for ``command_timeout_s`` the target becomes zero.
    """

    def __init__(self, params: SimParams) -> None:
        self.params = params
        self.speed = _STOP
        self._target = _STOP
        self._expires_ns: int | None = None

    def reset(self) -> None:
        self.speed = self._target = _STOP
        self._expires_ns = None

    def command(self, linear: float, angular: float, now_ns: int) -> bool:
        """Set the command; False (and no change) if it is not finite."""
        if not (math.isfinite(linear) and math.isfinite(angular)):
            return False
        p = self.params
        self._target = BodySpeed(
            min(max(linear, -p.max_reverse_speed_mps), p.max_speed_mps),
            min(max(angular, -p.max_yaw_rate_radps), p.max_yaw_rate_radps),
        )
        if p.command_timeout_s > 0:
            self._expires_ns = now_ns + round(p.command_timeout_s * 1e9)
        return True

    def advance(self, now_ns: int) -> BodySpeed:
        """Return the velocity of the next control period."""
        if self._expires_ns is not None and now_ns >= self._expires_ns:
            self._target, self._expires_ns = _STOP, None
        dw = self.params.max_yaw_accel_radps2 * CONTROL_PERIOD_S
        v, w = self.speed.linear, self.speed.angular
        self.speed = BodySpeed(
            self._next_linear(v, self._target.linear),
            w + min(max(self._target.angular - w, -dw), dw),
        )
        return self.speed

    def _next_linear(self, v: float, target: float) -> float:
        """Ramp with the deceleration towards zero and the acceleration away from it."""
        if v * (target - v) < 0:
            brake = self.params.max_decel_mps2 * CONTROL_PERIOD_S
            wanted = target if v * target > 0 else 0.0
            return v + min(max(wanted - v, -brake), brake)
        dv = self.params.max_accel_mps2 * CONTROL_PERIOD_S
        return v + min(max(target - v, -dv), dv)

    def constant_until_ns(self) -> float:
        """Time until which :meth:`advance` has no effect (0 while ramping)."""
        if self.speed != self._target:
            return 0.0
        return math.inf if self._expires_ns is None else float(self._expires_ns)
