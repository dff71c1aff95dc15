# SPDX-License-Identifier: Apache-2.0
"""Parameters of the simulated robot and of the simulator's node."""

from dataclasses import dataclass

from navette.errors import ParameterError
from navette.params import Params, param

CONTROL_PERIOD_S = 0.01  # cycle of the motor controller

LOCALIZATIONS = (
    *("truth", "odometry", "odometry+imu", "odometry+gnss", "odometry+imu+gnss"),
    *("slam", "slam+imu", "slam+wheels", "amcl", "amcl+imu", "amcl+wheels"),
)
"""Sources of the pose, with the sensors that the filter fuses with the wheels."""


@dataclass(frozen=True, kw_only=True)
class SimParams(Params):
    """Limits of the robot, noise of its sensors, and its frames."""

    timestep_s: float = param(
        0.002,
        "physics step; a whole number of them makes 10 ms",
        at_least=0.0005,
        at_most=0.01,
    )
    seed: int = param(0, "seed of all noise", at_least=0)

    command_timeout_s: float = param(
        0.5, "age of a command that stops the robot; 0 = no timeout", at_least=0.0
    )
    max_speed_mps: float = param(1.0, "fastest forward", above=0.0)
    max_reverse_speed_mps: float = param(0.5, "fastest backward", above=0.0)
    max_yaw_rate_radps: float = param(1.0, "fastest turn", above=0.0)
    max_accel_mps2: float = param(1.0, "maximum acceleration", above=0.0)
    max_decel_mps2: float = param(4.0, "maximum deceleration", above=0.0)
    max_yaw_accel_radps2: float = param(2.0, "maximum yaw acceleration", above=0.0)

    max_side_speed_mps: float = param(
        1.0, "mecanum: fastest to the left and to the right", above=0.0
    )
    max_steering_rate_radps: float = param(
        3.0, "Ackermann: fastest change of the steering angle", above=0.0
    )

    localization: str = param(
        "truth",
        "source of the pose: the true pose; odometry, which drifts (map = odom); or "
        "odometry that slam or amcl corrects by map → odom. Odometry is that of the "
        "wheels, fused by the filter ekf with the sensors after +; slam and amcl "
        "fuse the IMU unless +wheels",
        choices=LOCALIZATIONS,
    )
    wheel_noise_m: float = param(
        -1.0,
        "stddev of a wheel's measured travel after 1 m; grows with its square root; "
        "-1 = 0.01, and 0 with localization 'truth'",
        at_least=-1.0,
        at_most=0.5,
    )
    wheel_scale_error: float = param(
        0.0,
        "stddev of the constant relative error of each side's travel (wheel radius, "
        "tyre pressure), drawn once per seed",
        at_least=0.0,
        at_most=0.2,
    )
    wheel_slip_interval_m: float = param(
        0.0,
        "mean distance between two sudden slips of a wheel; 0 = none",
        at_least=0.0,
    )
    wheel_slip_m: float = param(
        0.05, "stddev of the false travel of a slip", at_least=0.0, at_most=1.0
    )
    imu_turn_rate_noise_radps: float = param(
        -1.0,
        "stddev of the IMU's turn rates; -1 = value of the robot's file, or, if "
        "that is 0 and localization is not 'truth', 0.005",
        at_least=-1.0,
        at_most=1.0,
    )
    imu_acceleration_noise_mps2: float = param(
        -1.0,
        "stddev of the IMU's specific force; -1 = value of the robot's file",
        at_least=-1.0,
        at_most=10.0,
    )
    imu_turn_rate_bias_radps: float = param(
        0.0,
        "stddev of the constant error of the IMU's turn rates, drawn once per seed",
        at_least=0.0,
        at_most=1.0,
    )
    imu_heading_drift_rad: float = param(
        0.0,
        "stddev of the IMU's heading after 1 s; grows with the square root of time",
        at_least=0.0,
        at_most=1.0,
    )
    lidar_noise_m: float = param(
        -1.0, "stddev of ranges; -1 = value of the robot's file", at_least=-1.0
    )
    lidar_dropout: float = param(
        0.0, "share of beams that return an invalid range", at_least=0.0, at_most=1.0
    )
    camera_renderer: str = param(
        "raycast",
        "camera renderer: ray casting, OpenGL, or OpenGL where it is available",
        choices=("raycast", "gl", "auto"),
    )

    map_frame: str = param("map", "world frame")
    odom_frame: str = param("odom", "odometry frame; may equal map_frame")
    base_frame: str = param(
        "base_link", "frame midway between the drive wheels, on the floor"
    )
    odometry_child_frame: str = param(
        "", "frame whose pose /odom/filtered contains; empty = base_frame"
    )
    link_frame_prefix: str = param("", "prefix of link names in frame names")

    clock_rate_hz: float = param(100.0, "/clock", at_least=0.01, at_most=1000.0)
    odometry_rate_hz: float = param(
        50.0, "/odom/filtered and /ground_truth", at_least=0.01, at_most=500.0
    )
    tf_rate_hz: float = param(50.0, "/tf of the base", at_least=0.01, at_most=50.0)
    joint_tf_rate_hz: float = param(
        10.0, "/tf and /joint_states of the wheels", at_least=0.01, at_most=50.0
    )

    @property
    def locator(self) -> str:
        """Source of the pose without its sensors: truth, odometry, slam or amcl."""
        return self.localization.partition("+")[0]

    @property
    def fused_sensors(self) -> frozenset[str]:
        """Sensors that the filter fuses with the wheels: "imu", "gnss"."""
        named = frozenset(self.localization.split("+")[1:])
        if self.is_corrected and not named:
            named = frozenset({"imu"})
        return named - {"wheels"}

    @property
    def filters_odometry(self) -> bool:
        """Whether the filter publishes the odometry instead of the simulator."""
        return bool(self.fused_sensors)

    @property
    def believes_truth(self) -> bool:
        """Whether the published odometry is the true pose."""
        return self.localization == "truth"

    @property
    def is_corrected(self) -> bool:
        """Whether another node publishes map → odom."""
        return self.locator in ("slam", "amcl")

    @property
    def odometry_frame(self) -> str:
        """Frame of the odometry; its own if map → odom is corrected."""
        own = self.is_corrected and self.odom_frame == self.map_frame
        return "odom" if own else self.odom_frame

    def turn_rate_stddev_radps(self, of_robot: float) -> float:
        """Return the standard deviation of an IMU's turn rates.

        Args:
            of_robot: value of the robot's file.
        """
        if self.imu_turn_rate_noise_radps >= 0.0:
            return self.imu_turn_rate_noise_radps
        return of_robot if of_robot > 0.0 or self.believes_truth else 0.005

    @property
    def wheel_stddev_m(self) -> float:
        """Standard deviation of a wheel's measured travel after 1 m."""
        if self.wheel_noise_m >= 0.0:
            return self.wheel_noise_m
        return 0.0 if self.believes_truth else 0.01

    def check(self) -> None:
        steps = CONTROL_PERIOD_S / self.timestep_s
        if abs(steps - round(steps)) > 1e-6:
            raise ParameterError(
                f"parameter 'timestep_s': {self.timestep_s!r} is not allowed; "
                f"expected {CONTROL_PERIOD_S} s divided by a whole number"
            )


# Parameters that are read at the start only.
FIXED_AT_START = frozenset(
    {
        *("timestep_s", "seed", "camera_renderer", "localization", "wheel_noise_m"),
        *("wheel_scale_error", "wheel_slip_interval_m", "wheel_slip_m"),
        *("imu_turn_rate_noise_radps", "imu_acceleration_noise_mps2"),
        *("imu_turn_rate_bias_radps", "imu_heading_drift_rad"),
        *("map_frame", "odom_frame", "base_frame", "odometry_child_frame"),
        *("link_frame_prefix", "clock_rate_hz", "odometry_rate_hz", "tf_rate_hz"),
        "joint_tf_rate_hz",
    }
)
