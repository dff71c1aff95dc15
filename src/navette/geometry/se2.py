"""Angles and poses in the plane: SE(2).

A pose named ``map_T_base`` takes points given in ``base`` to ``map``:
``p_map = map_T_base.apply(p_base)``; inner names match when multiplied:
``map_T_scan = map_T_base @ base_T_scan``.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray


def wrap_angle(angle: float) -> float:
    """Return the same angle in (−π, π], rad."""
    wrapped = math.remainder(angle, math.tau)
    return math.pi if wrapped == -math.pi else wrapped


def wrap_angles(angles: NDArray[np.floating[Any]]) -> NDArray[np.float64]:
    """Return the same angles in [−π, π), rad."""
    return np.asarray(np.remainder(angles + math.pi, math.tau) - math.pi)


def angle_difference(a: float, b: float) -> float:
    """Return ``a − b`` in (−π, π], rad."""
    return wrap_angle(a - b)


class Pose2(NamedTuple):
    """A planar pose: position (m) and yaw (rad, counter-clockwise from +x)."""

    x: float
    y: float
    yaw: float

    def __matmul__(self, other: "Pose2") -> "Pose2":
        x, y, yaw = self
        dx, dy, turn = other
        c, s = math.cos(yaw), math.sin(yaw)
        return Pose2(x + c * dx - s * dy, y + s * dx + c * dy, wrap_angle(yaw + turn))

    def inverse(self) -> "Pose2":
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return Pose2(
            -c * self.x - s * self.y, s * self.x - c * self.y, wrap_angle(-self.yaw)
        )

    def apply(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Transform points (N, 2) from the inner to the outer frame, metres."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        rotation = np.array([[c, s], [-s, c]])
        moved: NDArray[np.float64] = points @ rotation
        # As complex numbers: numpy adds a row of two numbers point by point.
        moved.view(np.complex128)[...] += complex(self.x, self.y)
        return moved

    def distance_to(self, other: "Pose2") -> float:
        """Distance between the two positions, metres."""
        return math.hypot(other.x - self.x, other.y - self.y)

    def interpolate(self, other: "Pose2", fraction: float) -> "Pose2":
        """Interpolate between ``self`` (0) and ``other`` (1), by the shorter turn."""
        return Pose2(
            self.x + fraction * (other.x - self.x),
            self.y + fraction * (other.y - self.y),
            wrap_angle(self.yaw + fraction * angle_difference(other.yaw, self.yaw)),
        )


def advanced(
    pose: Pose2, speed: float, turn_rate: float, seconds: float, *, side: float = 0.0
) -> Pose2:
    """Return the pose after an arc at constant speed (m/s) and turn rate (rad/s).

    ``side`` is the speed to the left of an omnidirectional drive.

    The chord of the arc has the length v t · sin(θ/2)/(θ/2), in the direction of half
    the turn θ = ω t.
    """
    half = turn_rate * seconds / 2
    c, s = math.cos(half), math.sin(half)
    share = seconds * (s / half if abs(half) > 1e-6 else 1.0)
    dx, dy = share * (speed * c - side * s), share * (speed * s + side * c)
    x, y, yaw = pose
    c, s = math.cos(yaw), math.sin(yaw)
    return Pose2(x + c * dx - s * dy, y + s * dx + c * dy, wrap_angle(yaw + 2 * half))
