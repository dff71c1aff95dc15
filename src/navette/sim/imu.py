# SPDX-License-Identifier: Apache-2.0
"""An inertial measurement unit."""

import math
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.geometry import Quaternion
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
        self._last: tuple[int, NDArray[np.float64]] | None = None
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
        position, world_R_sensor = self.mount.world(data)
        velocity, omega = state.point_velocity(position)
        acceleration = self._mean_acceleration(velocity, stamp_ns)
        force = world_R_sensor.T @ (acceleration - model.opt.gravity)
        rate = world_R_sensor.T @ omega
        quaternion = np.empty(4)
        mujoco.mju_mat2Quat(quaternion, world_R_sensor.ravel())
        self._turn(quaternion, stamp_ns, rng)
        w, x, y, z = quaternion.tolist()
        s = self.sensor
        if s.acceleration_stddev > 0:
            force = force + rng.normal(0.0, s.acceleration_stddev, 3)
        if s.angular_velocity_stddev > 0:
            rate = rate + rng.normal(0.0, s.angular_velocity_stddev, 3)
        if self._errors.turn_rate_bias > 0:
            rate = rate + self._bias
        return ImuReading(stamp_ns, (x, y, z, w), rate, force)

    def _turn(
        self, quaternion: NDArray[np.float64], stamp_ns: int, rng: np.random.Generator
    ) -> None:
        """Turn an orientation (w, x, y, z) about the vertical by the drift."""
        drift = self._errors.heading_drift
        if drift == 0.0:
            return
        seconds = max(0, stamp_ns - self._heading_ns) * 1e-9
        self._heading_ns = stamp_ns
        self._heading_error += drift * math.sqrt(seconds) * float(rng.normal())
        half = self._heading_error / 2
        error = np.array([math.cos(half), 0.0, 0.0, math.sin(half)])
        mujoco.mju_mulQuat(quaternion, error, quaternion.copy())

    def _mean_acceleration(
        self, velocity: NDArray[np.float64], stamp_ns: int
    ) -> NDArray[np.float64]:
        last, self._last = self._last, (stamp_ns, velocity)
        if last is None or not 0 < stamp_ns - last[0] <= _LONGEST_MEAN_NS:
            return np.zeros(3)  # no earlier velocity: assume no acceleration
        return (velocity - last[1]) / ((stamp_ns - last[0]) * 1e-9)
