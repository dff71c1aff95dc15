"""Conversion of messages to measurements, one object per input of the filter."""

import logging
import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import replace
from typing import Any, Protocol

import numpy as np

from navette.errors import InvalidInputError
from navette.geometry import Pose2, Quaternion, Transform3, yaw_of
from navette.geometry.geodesy import GeoPoint, LocalPlane
from navette.geometry.se3 import multiply, rotate, rotation_matrix
from navette.msgs.geometry_msgs.msg import Pose
from navette.msgs.sensor_msgs.msg import Imu, NavSatFix, NavSatStatus
from navette.navigation.localization.ekf.measurement import Measurement
from navette.navigation.localization.ekf.params import EkfParams
from navette.navigation.localization.ekf.readings import (
    LEAST_VARIANCE,
    FirstPoseIsZero,
    PoseChanges,
    Reading,
    Selection,
    measured,
    pose_reading,
    turned,
    twist_reading,
    without_variance,
)
from navette.navigation.localization.ekf.state import (
    AX,
    SPATIAL,
    VX,
    VYAW,
    YAW,
    Array,
    X,
    Y,
    is_covariance,
)

_LOG = logging.getLogger(__name__)
_PLANAR = np.ix_([0, 1, 5], [0, 1, 5])  # x, y, and turning about z, of six
# A larger value (m, m/s, …) would make later corrections overflow.
_LARGEST = 1e9
_LEVEL: Quaternion = (0.0, 0.0, 0.0, 1.0)


class Frames(Protocol):
    """Transforms between frames; raises TransformError if not connected."""

    def base_in(self, child: str) -> Transform3: ...  # child_T_base
    def in_world(self, frame: str) -> Transform3: ...  # world_T_frame


class FilterInput(ABC):
    """One input of the filter.

    Args:
        source: name of its topic parameter, such as ``odom0``.
        params: parameters of the filter.
        frames: transforms of its frames.
    """

    def __init__(self, source: str, params: EkfParams, frames: Frames) -> None:
        self.source = source
        self.params = params
        self.frames = frames
        self.selection = Selection.from_config(params.config_of(source))
        self._missing: set[str] = set()  # entries already warned about
        self.reset()

    def reset(self) -> None:
        """Drop the state of earlier messages."""
        self._changes = PoseChanges(round(self.params.max_gap_s * 1e9))
        self._first = FirstPoseIsZero()

    @abstractmethod
    def measurements(self, msg: Any, stamp_ns: int) -> Iterator[Measurement]:
        """Convert a message to measurements.

        Raises:
            InvalidInputError: not finite, out of range, or an invalid covariance.
            TransformError: its frame is not connected.
        """

    def _option(self, name: str) -> Any:
        return getattr(self.params, f"{self.source}_{name}")

    def _pose(
        self, msg: Any, child: str, stamp_ns: int, threshold: float
    ) -> Iterator[Measurement]:
        """Convert a PoseWithCovariance in the frame of the message's header."""
        if not self.selection.pose:
            return
        child_T_base = self.frames.base_in(child).to_pose2()
        reading = pose_reading(
            stamp_ns,
            self._pose_of(msg.pose.pose, child_T_base),
            _planar(msg.pose.covariance),
            child_T_base,
        )
        _check(reading)
        if self._option("differential"):
            change = self._changes.step(reading)
            if change is not None:
                yield self._measured(change, VX, self._as_twist(), threshold)
            return
        if self._option("relative"):
            reading = self._first.step(reading)
        else:
            world_T_frame = self.frames.in_world(msg.header.frame_id).to_pose2()
            reading = turned(reading, world_T_frame)
        yield self._measured(reading, X, self.selection.pose, threshold)

    def _pose_of(self, pose: Pose, child_T_base: Pose2) -> Pose2:
        """Return the pose; its heading is 0 if it is invalid and no value needs it.

        Also a heading that is not fused turns changes into the base's axes, and the
        offset of the child frame into the world's.
        """
        is_needed = (
            YAW in self.selection.pose
            or self._option("differential")
            or (child_T_base.x, child_T_base.y) != (0.0, 0.0)
        )
        q = pose.orientation
        yaw = yaw_of(_quaternion(q)) if is_needed or _is_unit(q) else 0.0
        return Pose2(pose.position.x, pose.position.y, yaw)

    def _twist(
        self, twist: Any, child: str, stamp_ns: int, threshold: float
    ) -> Iterator[Measurement]:
        """Convert a TwistWithCovariance in the frame ``child``."""
        if not self.selection.twist:
            return
        linear, angular = twist.twist.linear, twist.twist.angular
        reading = twist_reading(
            stamp_ns,
            np.array([linear.x, linear.y, angular.z]),
            _planar(twist.covariance),
            self.frames.base_in(child).to_pose2(),
        )
        _check(reading)
        yield self._measured(reading, VX, self.selection.twist, threshold)

    def _as_twist(self) -> tuple[int, ...]:
        return tuple(index + VX for index in self.selection.pose)

    def _measured(
        self, reading: Reading, first: int, chosen: tuple[int, ...], threshold: float
    ) -> Measurement:
        missing = without_variance(reading, first, chosen)
        if missing and missing not in self._missing:
            self._missing.add(missing)
            _LOG.warning(
                "%s: no variance of %s; %g is used",
                self.source,
                missing,
                LEAST_VARIANCE,
            )
        return measured(self.source, reading, first, chosen, threshold)


class OdometryInput(FilterInput):
    """nav_msgs/msg/Odometry: pose and velocity."""

    def measurements(self, msg: Any, stamp_ns: int) -> Iterator[Measurement]:
        child = msg.child_frame_id
        limit = self._option("pose_rejection_threshold")
        yield from self._pose(msg, child, stamp_ns, limit)
        limit = self._option("twist_rejection_threshold")
        yield from self._twist(msg.twist, child, stamp_ns, limit)


class PoseInput(FilterInput):
    """geometry_msgs/msg/PoseWithCovarianceStamped: the base's pose."""

    def measurements(self, msg: Any, stamp_ns: int) -> Iterator[Measurement]:
        child, limit = self.params.base_link_frame, self._option("rejection_threshold")
        yield from self._pose(msg, child, stamp_ns, limit)


class TwistInput(FilterInput):
    """geometry_msgs/msg/TwistWithCovarianceStamped: velocity in its own frame."""

    def measurements(self, msg: Any, stamp_ns: int) -> Iterator[Measurement]:
        child = msg.header.frame_id
        limit = self._option("rejection_threshold")
        yield from self._twist(msg.twist, child, stamp_ns, limit)


class ImuInput(FilterInput):
    """sensor_msgs/msg/Imu: heading, turn rate, acceleration.

    Roll and pitch are not filtered: :attr:`attitude` is the newest reading. Any
    mounting attitude is supported. The difference between its acceleration and that
    of the base while the robot turns is ignored.
    """

    def reset(self) -> None:
        super().reset()
        self.attitude: Quaternion = _LEVEL

    def measurements(self, msg: Imu, stamp_ns: int) -> Iterator[Measurement]:
        imu_R_base = self.frames.base_in(msg.header.frame_id).rotation
        if self._measures_tilt:
            self.attitude = multiply(self._orientation(msg), imu_R_base)
        if self.selection.pose:
            yield self._heading(msg, stamp_ns, imu_R_base)
        if self.selection.twist:
            rate, covariance = _in_base(
                imu_R_base, msg.angular_velocity, msg.angular_velocity_covariance
            )
            limit = self._option("twist_rejection_threshold")
            reading = Reading(stamp_ns, rate[2:], covariance[2:, 2:])
            _check(reading)
            yield self._measured(reading, VYAW, self.selection.twist, limit)
        if self.selection.acceleration:
            yield self._acceleration(msg, stamp_ns, imu_R_base)

    def _heading(self, msg: Imu, stamp_ns: int, imu_R_base: Any) -> Measurement:
        covariance = np.asarray(msg.orientation_covariance, float).reshape(3, 3)
        yaw = yaw_of(multiply(self._orientation(msg), imu_R_base))
        reading = Reading(stamp_ns, np.array([0.0, 0.0, yaw]), np.zeros((3, 3)))
        reading.covariance[2, 2] = covariance[2, 2]
        _check(reading)
        if self._option("relative"):
            reading = self._first.step(reading)
        return self._measured(
            reading, X, (YAW,), self._option("pose_rejection_threshold")
        )

    @property
    def _measures_tilt(self) -> bool:
        config = self.params.config_of(self.source)
        return config[SPATIAL.index("roll")] or config[SPATIAL.index("pitch")]

    def _orientation(self, msg: Imu) -> Quaternion:
        if msg.orientation_covariance[0] == -1.0:
            raise InvalidInputError(
                "no_orientation",
                "orientation_covariance[0] is -1: it measures no orientation",
            )
        return _quaternion(msg.orientation)

    def _acceleration(self, msg: Imu, stamp_ns: int, imu_R_base: Any) -> Measurement:
        force, covariance = _in_base(
            imu_R_base, msg.linear_acceleration, msg.linear_acceleration_covariance
        )
        if self._option("remove_gravitational_acceleration"):
            world_R_base = multiply(_quaternion(msg.orientation), imu_R_base)
            up = rotate(_inverse(world_R_base), (0.0, 0.0, 1.0))
            force = force - self.params.gravitational_acceleration_mps2 * np.array(up)
        reading = Reading(stamp_ns, force[:2], covariance[:2, :2])
        _check(reading)
        limit = self._option("linear_acceleration_rejection_threshold")
        return self._measured(reading, AX, self.selection.acceleration, limit)


class GnssInput(FilterInput):
    """sensor_msgs/msg/NavSatFix: antenna position east and north of the datum."""

    def reset(self) -> None:
        super().reset()
        datum = self.params.datum
        self._plane = None if datum is None else LocalPlane(datum)

    def measurements(self, msg: NavSatFix, stamp_ns: int) -> Iterator[Measurement]:
        if msg.status.status == NavSatStatus.STATUS_NO_FIX:
            raise InvalidInputError("no_fix", "it has no fix")
        place = GeoPoint(msg.latitude, msg.longitude, msg.altitude)
        if not place.is_valid:
            raise InvalidInputError(
                "out_of_range", f"{place}: expected a latitude and a longitude in range"
            )
        antenna = self.frames.base_in(msg.header.frame_id).inverse().translation
        if self._plane is None:
            self._plane = LocalPlane(place)
        covariance = np.asarray(msg.position_covariance, float).reshape(3, 3)[:2, :2]
        reading = Reading(stamp_ns, np.array(self._plane.east_north(place)), covariance)
        _check(reading)
        limit = self._option("rejection_threshold")
        seen = self._measured(reading, X, (X, Y), limit)
        yield replace(seen, lever=(antenna[0], antenna[1]))


KINDS: dict[str, type[FilterInput]] = {
    "odom0": OdometryInput,
    "odom1": OdometryInput,
    "pose0": PoseInput,
    "twist0": TwistInput,
    "imu0": ImuInput,
    "gps0": GnssInput,
}


def _check(reading: Reading) -> None:
    values = reading.values.tolist()
    if not all(map(math.isfinite, values)):
        raise InvalidInputError("not_finite", f"{values} are not finite")
    if max(map(abs, values)) > _LARGEST:
        raise InvalidInputError(
            "out_of_range", f"{values}; must be within ±{_LARGEST:g}"
        )
    if not is_covariance(reading.covariance):
        raise InvalidInputError(
            "invalid_covariance",
            f"its covariance {reading.covariance.tolist()} is not finite, not "
            "symmetric, has negative eigenvalues, or exceeds 1e18",
        )


def _planar(covariance: Any) -> Array:
    """Return (3, 3) of x, y and rotation about z, from a message's (36,)."""
    planar: Array = np.asarray(covariance, float).reshape(6, 6)[_PLANAR]
    return planar


def _is_unit(q: Any) -> bool:
    return 0.9 < math.hypot(q.x, q.y, q.z, q.w) < 1.1


def _quaternion(q: Any) -> Quaternion:
    if not _is_unit(q):
        values = [q.x, q.y, q.z, q.w]
        raise InvalidInputError(
            "invalid_orientation", f"its orientation {values} is not a unit quaternion"
        )
    return (q.x, q.y, q.z, q.w)


def _inverse(q: tuple[float, float, float, float]) -> Any:
    return (-q[0], -q[1], -q[2], q[3])


def _in_base(imu_R_base: Any, vector: Any, covariance: Any) -> tuple[Array, Array]:
    """Return a vector (3,) and its covariance (3, 3) along the base's axes."""
    R = rotation_matrix(_inverse(imu_R_base))
    turned_covariance = R @ np.asarray(covariance, float).reshape(3, 3) @ R.T
    return R @ np.array([vector.x, vector.y, vector.z]), turned_covariance
