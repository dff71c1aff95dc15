# SPDX-License-Identifier: Apache-2.0
"""Parameters of the simulated robot and of the simulator's node."""

from dataclasses import dataclass

from navette.errors import ParameterError
from navette.params import Params, param

CONTROL_PERIOD_S = 0.01  # cycle of the motor controller


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

    odometry: str = param(
        "true",
        "source of /odom/filtered: true pose, or dead reckoning by the wheels",
        choices=("true", "wheel"),
    )
    wheel_noise_m: float = param(
        0.0,
        "stddev of a wheel's measured travel after 1 m; grows with its square root",
        at_least=0.0,
        at_most=0.5,
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
        *("timestep_s", "seed", "camera_renderer", "odometry", "wheel_noise_m"),
        *("map_frame", "odom_frame", "base_frame", "odometry_child_frame"),
        *("link_frame_prefix", "clock_rate_hz", "odometry_rate_hz", "tf_rate_hz"),
        "joint_tf_rate_hz",
    }
)
