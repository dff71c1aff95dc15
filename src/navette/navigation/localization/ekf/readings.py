"""Poses, velocities and accelerations in the plane, as sensors give them."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from navette.geometry import Pose2, angle_difference
from navette.navigation.localization.ekf.measurement import Measurement
from navette.navigation.localization.ekf.state import (
    AX,
    NAMES,
    SPATIAL,
    VX,
    Array,
    is_covariance,
)

# Of a value that comes without: a sensor that knows better than this says so.
LEAST_VARIANCE = 1e-9


class Reading(NamedTuple):
    """Three values (or two) and how sure the sensor is of them."""

    stamp_ns: int
    values: Array
    """(n,) x, y, yaw or vx, vy, vyaw or ax, ay; m, rad, s"""
    covariance: Array
    """(n, n)"""

    @property
    def is_valid(self) -> bool:
        """All finite, the covariance one."""
        return bool(np.all(np.isfinite(self.values))) and is_covariance(self.covariance)


@dataclass(frozen=True)
class Selection:
    """Which entries of the state a sensor's message is used for."""

    pose: tuple[int, ...]
    twist: tuple[int, ...]
    acceleration: tuple[int, ...]

    @classmethod
    def from_config(cls, config: tuple[bool, ...]) -> "Selection":
        """From robot_localization's 15 booleans."""
        chosen = [
            NAMES.index(name)
            for name, wanted in zip(SPATIAL, config, strict=True)
            if wanted and name in NAMES
        ]
        return cls(
            tuple(index for index in chosen if index < VX),
            tuple(index for index in chosen if VX <= index < AX),
            tuple(index for index in chosen if index >= AX),
        )


def pose_reading(
    stamp_ns: int, world_T_child: Pose2, covariance: Array, child_T_base: Pose2
) -> Reading:
    """The base's pose from that of another frame of the robot.

    Args:
        covariance: (3, 3) of x, y, yaw of ``world_T_child``.
    """
    pose = world_T_child @ child_T_base
    J = np.eye(3)  # ∂(x, y, yaw of the base) / ∂(those of the child)
    J[0, 2] = -(pose.y - world_T_child.y)
    J[1, 2] = pose.x - world_T_child.x
    return Reading(stamp_ns, np.array(pose), J @ covariance @ J.T)


def turned(reading: Reading, outer_T_inner: Pose2) -> Reading:
    """A pose given in an inner frame, in the outer one."""
    pose = outer_T_inner @ Pose2(*reading.values)
    R = _rotation(outer_T_inner.yaw)
    return Reading(reading.stamp_ns, np.array(pose), R @ reading.covariance @ R.T)


def twist_reading(
    stamp_ns: int, twist: Array, covariance: Array, child_T_base: Pose2
) -> Reading:
    """The base's velocity along its axes from that of another frame of the robot.

    v_base = v_child + ω × p, turned into the base's axes (rigid body).

    Args:
        twist: (3,) vx, vy, vyaw in the child frame.
        covariance: (3, 3)
    """
    moved = np.eye(3)
    moved[0, 2], moved[1, 2] = -child_T_base.y, child_T_base.x
    A = _rotation(-child_T_base.yaw) @ moved
    return Reading(stamp_ns, A @ twist, A @ covariance @ A.T)


def measured(
    source: str,
    reading: Reading,
    first: int,
    chosen: tuple[int, ...],
    threshold: float,
) -> Measurement:
    """A reading's chosen entries; ``first`` is the state's entry of its first value."""
    rows = [index - first for index in chosen]
    covariance = reading.covariance[np.ix_(rows, rows)].copy()
    diagonal = np.einsum("ii->i", covariance)
    np.maximum(diagonal, LEAST_VARIANCE, out=diagonal)
    return Measurement(
        source, reading.stamp_ns, chosen, reading.values[rows], covariance, threshold
    )


def without_variance(reading: Reading, first: int, chosen: tuple[int, ...]) -> str:
    """Names of chosen entries whose variance was left at zero."""
    return ", ".join(
        NAMES[index]
        for index in chosen
        if reading.covariance[index - first, index - first] == 0.0
    )


class PoseChanges:
    """Velocities from poses that follow one another (``differential``)."""

    def __init__(self, max_gap_ns: int) -> None:
        self.max_gap_ns = max_gap_ns
        self._last: Reading | None = None

    def step(self, reading: Reading) -> Reading | None:
        """The velocity since the pose before; None if none came shortly before.

        Along the base's axes at the heading half way; the covariances of both poses
        count, as if independent.
        """
        last, self._last = self._last, reading
        if last is None or not 0 < reading.stamp_ns - last.stamp_ns <= self.max_gap_ns:
            return None
        dt = (reading.stamp_ns - last.stamp_ns) * 1e-9
        turn = angle_difference(reading.values[2], last.values[2])
        R = _rotation(-(last.values[2] + 0.5 * turn))
        change = R @ (reading.values - last.values)
        change[2] = turn
        covariance = R @ (reading.covariance + last.covariance) @ R.T / dt**2
        return Reading(reading.stamp_ns, change / dt, covariance)


class FirstPoseIsZero:
    """Poses seen from the first one (``relative``)."""

    def __init__(self) -> None:
        self._first_inverse: Pose2 | None = None

    def step(self, reading: Reading) -> Reading:
        """The pose in the frame of the first one."""
        if self._first_inverse is None:
            self._first_inverse = Pose2(*reading.values).inverse()
        return turned(reading, self._first_inverse)


def _rotation(yaw: float) -> Array:
    """(3, 3) that turns x and y, and leaves the third value."""
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
