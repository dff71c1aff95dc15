# SPDX-License-Identifier: Apache-2.0
"""Motor controller: velocity commands to wheel speeds and steering, within limits."""

import math
from typing import NamedTuple

from navette.sim.drive_geometry import DriveWheel
from navette.sim.params import CONTROL_PERIOD_S, SimParams
from navette.sim.scene import AckermannDrive, DiffDrive, MecanumDrive

CONTROL_PERIOD_NS = round(CONTROL_PERIOD_S * 1e9)
# Slower than this, a commanded yaw rate does not change the steering.
_STEER_FROM_MPS = 1e-3


class BodySpeed(NamedTuple):
    """Speed forward (m/s), yaw rate (rad/s) and speed to the left of the base.

    ``steering`` is the angle (rad) of an Ackermann drive.
    """

    linear: float = 0.0
    angular: float = 0.0
    side: float = 0.0
    steering: float = 0.0


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

    def command(
        self, linear: float, angular: float, now_ns: int, *, side: float = 0.0
    ) -> bool:
        """Set the command; False (and no change) if it is not finite."""
        if not all(map(math.isfinite, (linear, angular, side))):
            return False
        self._set(self._limited(linear, angular, side), now_ns)
        return True

    def _set(self, target: BodySpeed, now_ns: int) -> None:
        self._target = target
        if self.params.command_timeout_s > 0:
            self._expires_ns = now_ns + round(self.params.command_timeout_s * 1e9)

    def _limited(self, linear: float, angular: float, side: float) -> BodySpeed:
        """Return the nearest velocity that this drive can have."""
        del side
        turn = self.params.max_yaw_rate_radps
        return BodySpeed(self._speed(linear), min(max(angular, -turn), turn))

    def _speed(self, linear: float) -> float:
        p = self.params
        return min(max(linear, -p.max_reverse_speed_mps), p.max_speed_mps)

    def advance(self, now_ns: int) -> BodySpeed:
        """Return the velocity of the next control period."""
        if self._expires_ns is not None and now_ns >= self._expires_ns:
            self._target, self._expires_ns = self._rest(), None
        self.speed = self._next()
        return self.speed

    def _rest(self) -> BodySpeed:
        return _STOP

    def _next(self) -> BodySpeed:
        now, target = self.speed, self._target
        return BodySpeed(
            self._next_linear(now.linear, target.linear),
            self._next_yaw_rate(now.angular, target.angular),
        )

    def _next_yaw_rate(self, w: float, target: float) -> float:
        return _stepped(w, target, self.params.max_yaw_accel_radps2)

    def _next_linear(self, v: float, target: float) -> float:
        """Ramp with the deceleration towards zero and the acceleration away from it."""
        if v * (target - v) < 0:
            wanted = target if v * target > 0 else 0.0
            return _stepped(v, wanted, self.params.max_decel_mps2)
        return _stepped(v, target, self.params.max_accel_mps2)

    def constant_until_ns(self) -> float:
        """Time until which :meth:`advance` has no effect (0 while ramping)."""
        if self.speed != self._target:
            return 0.0
        return math.inf if self._expires_ns is None else float(self._expires_ns)


class MecanumRamp(SpeedRamp):
    """The ramp of a drive that also moves sideways."""

    def _limited(self, linear: float, angular: float, side: float) -> BodySpeed:
        rolling = super()._limited(linear, angular, 0.0)
        most = self.params.max_side_speed_mps
        sideways = min(max(side, -most), most)
        return BodySpeed(rolling.linear, rolling.angular, sideways)

    def _next(self) -> BodySpeed:
        rolling = super()._next()
        side = self._next_linear(self.speed.side, self._target.side)
        return BodySpeed(rolling.linear, rolling.angular, side)


class SteeringRamp(SpeedRamp):
    """The ramp of an Ackermann drive: speed and steering angle.

    A yaw rate is converted to the steering angle for the commanded speed; at
    standstill the angle stays.
    """

    def __init__(self, params: SimParams, drive: AckermannDrive) -> None:
        super().__init__(params)
        self._drive = drive

    def steer(self, speed: float, steering: float, now_ns: int) -> bool:
        """Set speed and steering angle; False (and no change) if not finite."""
        if not (math.isfinite(speed) and math.isfinite(steering)):
            return False
        self._set(self._bend(self._speed(speed), steering), now_ns)
        return True

    def _limited(self, linear: float, angular: float, side: float) -> BodySpeed:
        speed = self._speed(linear)
        if abs(speed) < _STEER_FROM_MPS:
            return self._bend(0.0, self._target.steering)
        return self._bend(speed, math.atan(self._drive.wheel_base * angular / speed))

    def _rest(self) -> BodySpeed:
        return self._bend(0.0, self._target.steering)

    def _bend(self, speed: float, steering: float) -> BodySpeed:
        limit = self._drive.steering_limit
        steering = min(max(steering, -limit), limit)
        yaw_rate = speed * self._drive.curvature_of(steering)
        return BodySpeed(speed, yaw_rate, steering=steering)

    def _next(self) -> BodySpeed:
        now, target = self.speed, self._target
        rate = self.params.max_steering_rate_radps
        return self._bend(
            self._next_linear(now.linear, target.linear),
            _stepped(now.steering, target.steering, rate),
        )


def make_ramp(params: SimParams, drive: DiffDrive) -> SpeedRamp:
    """Return the motor controller of a drive."""
    if isinstance(drive, AckermannDrive):
        return SteeringRamp(params, drive)
    return MecanumRamp(params) if isinstance(drive, MecanumDrive) else SpeedRamp(params)


def _stepped(value: float, target: float, rate: float) -> float:
    """Return the value after a control period at most ``rate`` per second nearer."""
    step = rate * CONTROL_PERIOD_S
    return value + min(max(target - value, -step), step)


def rim_speed(wheel: DriveWheel, drive: DiffDrive, speed: BodySpeed) -> float:
    """Return the speed (m/s) of a wheel's rim at a velocity of the base."""
    turning = wheel.side * speed.angular * drive.wheel_separation / 2
    return speed.linear - turning - wheel.slide * speed.side
