# SPDX-License-Identifier: Apache-2.0
"""Dead reckoning by wheel encoders: drifts as wheels slip and sensors err."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from navette.geometry import Pose2
from navette.sim.scene import DiffDrive

Matrix = np.ndarray[Any, np.dtype[np.float64]]

_SAME = Pose2(0.0, 0.0, 0.0)
#: Lower bound of stated standard deviations (m, rad and per second): a variance of 0
#: means "unknown" to some readers and "exact" to others.
LEAST_STDDEV = 1e-3


@dataclass(frozen=True)
class WheelMotion:
    """Mean speed (m/s) and yaw rate (rad/s) of the axle midpoint over an interval.

    ``side`` is the speed to the left of a drive that moves sideways.

    ``covariance``: (3, 3) of forward speed, sideways speed, yaw rate.
    """

    speed: float
    yaw_rate: float
    covariance: Matrix
    side: float = 0.0


@dataclass(frozen=True)
class PlanarCovariances:
    """Covariances of a pose (x, y, yaw) and of a motion in the body frame.

    Both (3, 3).
    """

    pose: Matrix
    twist: Matrix

    def of_child(self, frame_T_base: Pose2, base_T_child: Pose2) -> "PlanarCovariances":
        """Transform from the base to a frame fixed to it."""
        if base_T_child == _SAME:
            return self
        x, y, turn = base_T_child
        child = frame_T_base @ base_T_child
        pose_J_base = _lever(child.x - frame_T_base.x, child.y - frame_T_base.y)
        c, s = math.cos(turn), math.sin(turn)
        child_R_base = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        twist_J_base = child_R_base @ _lever(x, y)
        return PlanarCovariances(
            pose_J_base @ self.pose @ pose_J_base.T,
            twist_J_base @ self.twist @ twist_J_base.T,
        )


@dataclass(frozen=True)
class WheelErrors:
    """Errors of the measured travel of each side of the drive.

    Attributes:
        noise: standard deviation (m) after 1 m; the variance grows with the distance.
        scale: standard deviation of a constant relative error, drawn once per run.
        slip_interval: mean distance (m) between sudden slips; 0 = none.
        slip: standard deviation of the false travel of a slip (m).
    """

    noise: float = 0.0
    scale: float = 0.0
    slip_interval: float = 0.0
    slip: float = 0.0


class WheelOdometry:
    """Integrates wheel rotations along circular arcs.

    The covariances follow from the noise of the measured travel to first order
    (Siegwart, Nourbakhsh, Scaramuzza, "Autonomous Mobile Robots", 2nd ed., section
    5.2.4) and include neither a wrong scale nor slip, as those of real encoders.
    """

    def __init__(self, drive: DiffDrive, errors: WheelErrors) -> None:
        self._drive = drive
        self._errors = errors
        self._noise = errors.noise
        self._scales = (1.0, 1.0)
        self.reset(Pose2(0.0, 0.0, 0.0), (0.0, 0.0))

    def draw_scales(self, rng: np.random.Generator) -> None:
        """Draw the constant errors of this run."""
        if self._errors.scale > 0.0:
            left, right = (1.0 + self._errors.scale * rng.normal(size=2)).tolist()
            self._scales = left, right

    def reset(
        self, pose: Pose2, wheels: tuple[float, float], slide: float = 0.0
    ) -> None:
        """Start at an exact pose with the encoders at these angles (rad)."""
        self.pose = pose
        self._wheels = wheels
        self._slide = slide
        self._side = 0.0  # metres since the last call of motion
        self._stamp_ns = self._published_ns = 0
        self._covariance = np.zeros((3, 3))
        self._left = self._right = 0.0  # metres since the last call of motion
        self._spread = (0.0, 0.0)  # variances of these
        self._motion = WheelMotion(0.0, 0.0, _FLOOR)

    @property
    def pose_covariance(self) -> Matrix:
        """(3, 3) of x, y, yaw of :attr:`pose`, in its frame."""
        return self._covariance + _FLOOR

    def update(
        self,
        wheels: tuple[float, float],
        stamp_ns: int,
        rng: np.random.Generator,
        *,
        slide: float = 0.0,
    ) -> Pose2:
        """Integrate up to encoder angles ``wheels`` (left, right; rad).

        ``slide`` is the rotation of mecanum wheels that moves the base to the left; its
        error has the variance of the mean of both sides.
        """
        radius = self._drive.wheel_radius
        true_left = (wheels[0] - self._wheels[0]) * radius
        true_right = (wheels[1] - self._wheels[1]) * radius
        left = self._scales[0] * self._measured(true_left, rng)
        right = self._scales[1] * self._measured(true_right, rng)
        self._wheels = wheels
        self._stamp_ns = stamp_ns
        # Variances of the measured travel would correlate with the errors that they
        # describe, and bias a filter.
        spread = self._noise**2 * abs(true_left), self._noise**2 * abs(true_right)
        self._left, self._right = self._left + left, self._right + right
        self._spread = self._spread[0] + spread[0], self._spread[1] + spread[1]
        true_side = (slide - self._slide) * radius
        side = self._measured(true_side, rng) if true_side else 0.0
        self._slide = slide
        self._side += side
        travel, turn = self._travel_and_turn(left, right)
        self._move(travel, turn, side, self._step_covariance(spread))
        return self.pose

    def motion(self) -> WheelMotion:
        """Mean motion since the :meth:`update` before the previous call."""
        seconds = (self._stamp_ns - self._published_ns) * 1e-9
        if seconds > 0:
            travel, turn = self._travel_and_turn(self._left, self._right)
            covariance = _FLOOR.copy()
            covariance[_FORWARD_AND_YAW] += (
                self._step_covariance(self._spread) / seconds**2
            )
            covariance[1, 1] += self._noise**2 * abs(self._side) / seconds**2
            self._motion = WheelMotion(
                travel / seconds, turn / seconds, covariance, self._side / seconds
            )
            self._published_ns = self._stamp_ns
            self._left = self._right = self._side = 0.0
            self._spread = (0.0, 0.0)
        return self._motion

    def _travel_and_turn(self, left: float, right: float) -> tuple[float, float]:
        return (left + right) / 2, (right - left) / self._drive.wheel_separation

    def _step_covariance(self, spread: tuple[float, float]) -> Matrix:
        """(2, 2) of travel and turn, from the variances of left and right."""
        base = self._drive.wheel_separation
        total, skew = spread[0] + spread[1], (spread[1] - spread[0]) / (2 * base)
        return np.array([[total / 4, skew], [skew, total / base**2]])

    def _move(
        self, travel: float, turn: float, side: float, covariance: Matrix
    ) -> None:
        # Chord of the arc: along the mean heading, shorter by sinc(turn / 2).
        half = turn / 2
        chord = math.sin(half) / half if abs(half) > 1e-9 else 1.0
        dx, dy, cos, sin = travel * chord, side * chord, math.cos(half), math.sin(half)
        step = Pose2(dx * cos - dy * sin, dx * sin + dy * cos, turn)
        before, self.pose = self.pose, self.pose @ step
        x, y = self.pose.x - before.x, self.pose.y - before.y
        c, s = math.cos(before.yaw + half), math.sin(before.yaw + half)
        F = _lever(x, y)
        G = np.array([[c, -y / 2], [s, x / 2], [0.0, 1.0]])
        self._covariance = F @ self._covariance @ F.T + G @ covariance @ G.T
        if side:
            across = np.array([-s, c, 0.0])
            self._covariance += self._noise**2 * abs(side) * np.outer(across, across)

    def _measured(self, travel: float, rng: np.random.Generator) -> float:
        errors = self._errors
        if errors.slip_interval > 0.0:
            slips = int(rng.poisson(abs(travel) / errors.slip_interval))
            travel += errors.slip * math.sqrt(slips) * float(rng.normal())
        if self._noise == 0:
            return travel
        return travel + self._noise * math.sqrt(abs(travel)) * float(rng.normal())


_FORWARD_AND_YAW = np.ix_([0, 2], [0, 2])
_FLOOR = np.eye(3) * LEAST_STDDEV**2


def _lever(x: float, y: float) -> Matrix:
    """(3, 3) Jacobian of a point at (x, y) with respect to the origin's motion."""
    return np.array([[1.0, 0.0, -y], [0.0, 1.0, x], [0.0, 0.0, 1.0]])
