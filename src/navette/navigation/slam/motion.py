"""ScanMotion between two scans, before they are matched."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2, angle_difference, wrap_angle
from navette.navigation.slam.params import SlamParams

Matrix3 = NDArray[np.float64]
"""(3, 3) over x, y, yaw."""

HERE = Pose2(0.0, 0.0, 0.0)
# A faster motion is a jump of the odometry: it was reset, or the robot was carried.
_JUMP_MPS, _JUMP_M = 5.0, 2.0
# Standard deviation of yaw by an IMU, per radian turned.
_IMU_NOISE = 0.02
_LONGEST_S = 1.0
# Standard deviations of no motion, so that a covariance can be inverted.
_LEAST_M, _LEAST_RAD = 1e-3, 1e-3


class ScanMotion(NamedTuple):
    """ScanMotion of the base, in the frame of its start."""

    pose: Pose2
    covariance: Matrix3


class MotionModel:
    """Predict motions from odometry, an IMU's yaw, or the velocity before.

    Attributes:
        is_measured: whether the odometry measured the motion of the last step.
    """

    def __init__(self, params: SlamParams) -> None:
        self.params = params
        self.is_measured = False
        self._stamp_ns: int | None = None
        self._odometry: Pose2 | None = None
        self._yaw: float | None = None
        self._velocity = HERE
        self._seconds = 0.0

    def step(
        self, stamp_ns: int, odom_T_base: Pose2 | None, yaw: float | None = None
    ) -> ScanMotion:
        """Return the motion since the step before; the first one is none.

        Args:
            stamp_ns: of the scan.
            odom_T_base: pose by odometry, or None.
            yaw: heading by an IMU, in a frame that does not turn, or None.
        """
        before, self._odometry = self._odometry, odom_T_base
        yaw_before, self._yaw = self._yaw, yaw
        if self._stamp_ns is not None:
            self._seconds = max(0.0, (stamp_ns - self._stamp_ns) / 1e9)
        self._stamp_ns = stamp_ns
        motion, self.is_measured = self.steady(), False
        if before is not None and odom_T_base is not None:
            measured = _between(before, odom_T_base, self.params)
            away = math.hypot(measured.pose.x, measured.pose.y)
            if away < _JUMP_M + _JUMP_MPS * self._seconds:
                motion, self.is_measured = measured, True
        if yaw_before is not None and yaw is not None:
            turn = angle_difference(yaw, yaw_before)
            covariance = motion.covariance.copy()
            deviation = self.params.odometry_floor_rad + _IMU_NOISE * abs(turn)
            covariance[2, 2] = deviation**2
            pose = Pose2(motion.pose.x, motion.pose.y, turn)
            motion = ScanMotion(pose, covariance)
        return motion

    def by_odometry(self, odom_T_base: Pose2) -> ScanMotion:
        """Return the motion since the last step; the step itself is not made."""
        return _between(self._odometry or odom_T_base, odom_T_base, self.params)

    def steady(self) -> ScanMotion:
        """Return the motion of the last step at the velocity before it."""
        seconds, params = min(self._seconds, _LONGEST_S), self.params
        motion = Pose2(*(seconds * value for value in self._velocity))
        change = params.max_acceleration_mps2 * seconds * seconds
        turn = params.max_yaw_acceleration_radps2 * seconds * seconds
        position = params.odometry_floor_m + change
        yaw = params.odometry_floor_rad + turn
        return ScanMotion(motion, np.diag([position**2, position**2, yaw**2]))

    def record(self, motion: Pose2) -> None:
        """Store the motion of the last step as it was found by matching."""
        if self._seconds > 0.0:
            self._velocity = Pose2(*(value / self._seconds for value in motion))


def _between(before: Pose2, after: Pose2, params: SlamParams) -> ScanMotion:
    measured = before.inverse() @ after
    return ScanMotion(measured, motion_covariance(measured, params))


def motion_covariance(motion: Pose2, params: SlamParams) -> Matrix3:
    """Return the covariance (3, 3) of a motion by odometry between two scans."""
    floors = params.odometry_floor_m, params.odometry_floor_rad
    return _odometry_covariance(motion, params, *floors)


def section_covariance(motion: Pose2, params: SlamParams) -> Matrix3:
    """Return the covariance (3, 3) of a section of a motion by odometry alone.

    The errors of a pose that the robot need not move for do not add up.
    """
    return _odometry_covariance(motion, params, _LEAST_M, _LEAST_RAD)


def _odometry_covariance(
    motion: Pose2, params: SlamParams, floor_m: float, floor_rad: float
) -> Matrix3:
    distance, turn = math.hypot(motion.x, motion.y), abs(motion.yaw)
    position = floor_m + params.odometry_noise * distance
    yaw = (
        floor_rad + params.odometry_noise * turn + params.odometry_yaw_per_m * distance
    )
    return np.diag([position**2, position**2, yaw**2])


def moved_covariance(
    covariance: Matrix3, map_T_base: Pose2, motion: ScanMotion
) -> Matrix3:
    """Return the covariance of x, y, yaw in the map after a motion.

    Args:
        covariance: (3, 3) before the motion.
        map_T_base: the pose before.
        motion: base before → base after.
    """
    c, s = math.cos(map_T_base.yaw), math.sin(map_T_base.yaw)
    step = motion.pose
    jacobian = np.eye(3)
    jacobian[0, 2] = -s * step.x - c * step.y
    jacobian[1, 2] = c * step.x - s * step.y
    turn = rotation3(map_T_base.yaw)
    moved = jacobian @ covariance @ jacobian.T + turn @ motion.covariance @ turn.T
    symmetric: Matrix3 = (moved + moved.T) / 2.0
    return symmetric


def inverted(matrix: Matrix3) -> Matrix3:
    """Return the inverse: information of a covariance, or the reverse."""
    result: Matrix3 = np.linalg.inv(matrix).astype(np.float64)
    return result


def rotation3(yaw: float) -> Matrix3:
    """Return the (3, 3) rotation of x and y that leaves the yaw."""
    c, s = math.cos(wrap_angle(yaw)), math.sin(wrap_angle(yaw))
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
