"""Planar poses, velocities and accelerations from sensors."""

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
)

# Used for a value without variance.
LEAST_VARIANCE = 1e-9


class Reading(NamedTuple):
    """Up to three values and their covariance."""

    stamp_ns: int
    values: Array
    """(n,) x, y, yaw or vx, vy, vyaw or ax, ay; m, rad, s"""
    covariance: Array
    """(n, n)"""


@dataclass(frozen=True)
class Selection:
    """Entries of the state for which an input is used."""

    pose: tuple[int, ...]
    twist: tuple[int, ...]
    acceleration: tuple[int, ...]

    @classmethod
    def from_config(cls, config: tuple[bool, ...]) -> "Selection":
        """Create from robot_localization's 15 booleans."""
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
    """Return the base's pose from that of another frame of the robot.

    Args:
        covariance: (3, 3) of x, y, yaw of ``world_T_child``.
    """
    pose = world_T_child @ child_T_base
    J = np.eye(3)  # ∂(x, y, yaw of the base) / ∂(those of the child)
    J[0, 2] = -(pose.y - world_T_child.y)
    J[1, 2] = pose.x - world_T_child.x
    return Reading(stamp_ns, np.array(pose), J @ covariance @ J.T)


def turned(reading: Reading, outer_T_inner: Pose2) -> Reading:
    """Transform a pose from an inner to the outer frame."""
    pose = outer_T_inner @ Pose2(*reading.values)
    R = _rotation(outer_T_inner.yaw)
    return Reading(reading.stamp_ns, np.array(pose), R @ reading.covariance @ R.T)


def twist_reading(
    stamp_ns: int, twist: Array, covariance: Array, child_T_base: Pose2
) -> Reading:
    """Return the base's velocity along its axes from that of another frame.

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
    """Return the chosen entries; ``first`` is the state entry of the first value."""
    rows = np.array(chosen) - first
    covariance = reading.covariance[rows[:, None], rows]
    for i in range(len(rows)):
        covariance[i, i] = max(covariance[i, i], LEAST_VARIANCE)
    return Measurement(
        source, reading.stamp_ns, chosen, reading.values[rows], covariance, threshold
    )


def without_variance(reading: Reading, first: int, chosen: tuple[int, ...]) -> str:
    """Return the names of chosen entries with zero variance."""
    return ", ".join(
        NAMES[index]
        for index in chosen
        if reading.covariance[index - first, index - first] == 0.0
    )


class PoseChanges:
    """Velocities from consecutive poses (``differential``)."""

    def __init__(self, max_gap_ns: int) -> None:
        self.max_gap_ns = max_gap_ns
        self._last: Reading | None = None

    def step(self, reading: Reading) -> Reading | None:
        """Return the velocity since the previous pose; None without a recent one.

        Along the base's axes at the mean heading; the covariances of both poses are
        added as if independent.
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
    """Poses relative to the first one (``relative``)."""

    def __init__(self) -> None:
        self._first_inverse: Pose2 | None = None

    def step(self, reading: Reading) -> Reading:
        """Return the pose in the frame of the first one."""
        if self._first_inverse is None:
            self._first_inverse = Pose2(*reading.values).inverse()
        return turned(reading, self._first_inverse)


def _rotation(yaw: float) -> Array:
    """Return (3, 3) that rotates x and y and keeps the third value."""
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
