"""Motions of the behaviors: the velocity to aim at, and when they are complete."""

import math
from typing import NamedTuple, Protocol

from navette.geometry import Pose2, angle_difference
from navette.navigation.behaviors.params import BehaviorParams

# Least speeds shortly before the end: below them some drives do not move.
_CREEP_MPS, _CREEP_RADPS = 0.03, 0.08


class VelocityTarget(NamedTuple):
    """Velocity (m/s, rad/s) to aim at, and for how long it continues (s)."""

    speed: float
    turn_rate: float
    left_s: float


class MeasuredMotion(NamedTuple):
    """Pose of the base in the map, its motion (m/s, rad/s), and its pose in odom.

    The pose in odom is continuous, for lengths of motions; the one in the map may jump.
    """

    pose: Pose2
    speed: float
    turn_rate: float
    odom_T_base: Pose2


class BaseMotion(Protocol):
    """A motion from the pose of its first step on."""

    @property
    def progress(self) -> float:
        """Metres driven or radians turned."""

    def step(self, now: MeasuredMotion) -> VelocityTarget | None:
        """Return the velocity to aim at; None when the motion is complete."""


class DriveStraight:
    """Drive a distance straight ahead, or back if it is negative.

    Args:
        distance_m: signed distance.
        speed_mps: magnitude of the speed.
        params: limits and tolerance.
    """

    def __init__(
        self, distance_m: float, speed_mps: float, params: BehaviorParams
    ) -> None:
        self._distance = distance_m
        self._speed = min(abs(speed_mps), params.max_speed_mps)
        self._params = params
        self._start: Pose2 | None = None
        self.progress = 0.0

    def step(self, now: MeasuredMotion) -> VelocityTarget | None:
        self._start = self._start or now.odom_T_base
        self.progress = self._start.distance_to(now.odom_T_base)
        left = abs(self._distance) - self.progress
        if left <= self._params.distance_tolerance_m:
            return None
        speed = _approach(
            left - abs(now.speed) * self._params.reaction_s,
            self._params.deceleration_mps2,
            _CREEP_MPS,
            self._speed,
        )
        return VelocityTarget(math.copysign(speed, self._distance), 0.0, left / speed)


class TurnBy:
    """Turn in place by an angle of any size; positive is counter-clockwise."""

    def __init__(self, angle_rad: float, params: BehaviorParams) -> None:
        self._angle = angle_rad
        self._params = params
        self._yaw: float | None = None
        self._turned = 0.0

    @property
    def progress(self) -> float:
        return self._turned

    def step(self, now: MeasuredMotion) -> VelocityTarget | None:
        if self._yaw is not None:
            self._turned += angle_difference(now.odom_T_base.yaw, self._yaw)
        self._yaw = now.odom_T_base.yaw
        left = abs(self._angle) - math.copysign(1.0, self._angle) * self._turned
        if left <= self._params.yaw_tolerance_rad:
            return None
        rate = _approach(
            left - abs(now.turn_rate) * self._params.reaction_s,
            self._params.turn_acceleration_radps2,
            _CREEP_RADPS,
            self._params.max_turn_rate_radps,
        )
        return VelocityTarget(0.0, math.copysign(rate, self._angle), left / rate)


def _approach(left: float, deceleration: float, least: float, most: float) -> float:
    """Return the speed from which the robot stops in the distance that is left."""
    speed = math.sqrt(2 * deceleration * max(0.0, left))
    return min(most, max(least, speed))
