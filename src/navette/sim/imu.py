# SPDX-License-Identifier: Apache-2.0
"""An inertial measurement unit."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Quaternion, Vector3, quaternion_from_yaw
from navette.geometry.se3 import multiply, rotate
from navette.sim.instant import Instant
from navette.sim.mount import Mount
from navette.sim.sensor_specs import ImuSensor

_LONGEST_MEAN_NS = 200_000_000


class ImuReading(NamedTuple):
    """In the sensor's frame: angular velocity (rad/s), specific force (m/s²)."""

    stamp_ns: int
    orientation: Quaternion  # world_R_sensor
    angular_velocity: NDArray[np.float64]
    linear_acceleration: NDArray[np.float64]


class ImuErrors(NamedTuple):
    """Errors beside the sensor's white noise; standard deviations.

    Attributes:
        turn_rate_bias: of a constant error of each turn rate (rad/s).
        heading_drift: of the heading after 1 s (rad); grows with the root of time.
    """

    turn_rate_bias: float = 0.0
    heading_drift: float = 0.0


NO_ERRORS = ImuErrors()


class Imu:
    """Specific force is the mean since the last reading, as of integrating units.

    f = R^T (Δv / Δt − g), with v the velocity of the sensor's origin. A first reading,
    or one after a long pause, assumes no acceleration.
    """

    def __init__(
        self, sensor: ImuSensor, mount: Mount, errors: ImuErrors = NO_ERRORS
    ) -> None:
        self.sensor = sensor
        self.mount = mount
        self._errors = errors
        self._last: tuple[int, Vector3] | None = None
        self._bias = np.zeros(3)
        self._heading_error = 0.0  # rad
        self._heading_ns = 0

    def reset(self, rng: np.random.Generator) -> None:
        """Restart, with new constant errors."""
        self._last = None
        self._heading_error, self._heading_ns = 0.0, 0
        if self._errors.turn_rate_bias > 0:
            self._bias = rng.normal(0.0, self._errors.turn_rate_bias, 3)

    def read(self, instant: Instant, rng: np.random.Generator) -> ImuReading:
        """Return the reading of an instant."""
        model, data, state, stamp_ns, _ = instant
        # In plain numbers: NumPy takes four times as long for three of them.
        position, orientation = self.mount.pose(data)
        x, y, z, w = orientation
        sensor_R_world = (-x, -y, -z, w)
        velocity, omega = state.point_velocity(position)
        ax, ay, az = self._mean_acceleration(velocity, stamp_ns)
        gx, gy, gz = model.opt.gravity.tolist()
        force = np.array(rotate(sensor_R_world, (ax - gx, ay - gy, az - gz)))
        rate = np.array(rotate(sensor_R_world, omega))
        orientation = self._turned(orientation, stamp_ns, rng)
        s = self.sensor
        if s.acceleration_stddev > 0:
            force += rng.normal(0.0, s.acceleration_stddev, 3)
        if s.angular_velocity_stddev > 0:
            rate += rng.normal(0.0, s.angular_velocity_stddev, 3)
        if self._errors.turn_rate_bias > 0:
            rate += self._bias
        return ImuReading(stamp_ns, orientation, rate, force)

    def _turned(
        self, orientation: Quaternion, stamp_ns: int, rng: np.random.Generator
    ) -> Quaternion:
        """Turn an orientation about the vertical by the drift."""
        drift = self._errors.heading_drift
        if drift == 0.0:
            return orientation
        seconds = max(0, stamp_ns - self._heading_ns) * 1e-9
        self._heading_ns = stamp_ns
        self._heading_error += drift * math.sqrt(seconds) * float(rng.normal())
        return multiply(quaternion_from_yaw(self._heading_error), orientation)

    def _mean_acceleration(self, velocity: Vector3, stamp_ns: int) -> Vector3:
        last, self._last = self._last, (stamp_ns, velocity)
        if last is None or not 0 < stamp_ns - last[0] <= _LONGEST_MEAN_NS:
            return (0.0, 0.0, 0.0)  # no earlier velocity: assume no acceleration
        (vx, vy, vz), (x, y, z) = velocity, last[1]
        seconds = (stamp_ns - last[0]) * 1e-9
        return ((vx - x) / seconds, (vy - y) / seconds, (vz - z) / seconds)
