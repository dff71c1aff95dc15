# SPDX-License-Identifier: Apache-2.0
"""Parameters of the simulated robot and of the simulator's node."""

from dataclasses import dataclass

from navette.errors import ParameterError
from navette.params import Params, param

CONTROL_PERIOD_S = 0.01  # a motor controller's cycle


@dataclass(frozen=True, kw_only=True)
class SimParams(Params):
    """A robot's limits, what its sensors suffer from, and its frames."""

    timestep_s: float = param(
        0.002,
        "physics step; a whole number of them makes 10 ms",
        unit="s",
        at_least=0.0005,
        at_most=0.01,
    )
    seed: int = param(0, "seed of all noise", at_least=0)

    command_timeout_s: float = param(
        0.5,
        "a command older than this stops the robot; 0 = never",
        unit="s",
        at_least=0.0,
    )
    max_speed_mps: float = param(1.0, "fastest forward", unit="m/s", above=0.0)
    max_reverse_speed_mps: float = param(0.5, "fastest backward", unit="m/s", above=0.0)
    max_yaw_rate_radps: float = param(1.0, "fastest turn", unit="rad/s", above=0.0)
    max_accel_mps2: float = param(1.0, "growth of speed", unit="m/s²", above=0.0)
    max_decel_mps2: float = param(
        4.0, "decrease of speed: how hard the brakes are", unit="m/s²", above=0.0
    )
    max_yaw_accel_radps2: float = param(
        2.0, "change of yaw rate", unit="rad/s²", above=0.0
    )

    odometry: str = param(
        "true",
        "what /odom/filtered carries: the true pose, or dead reckoning by the wheels",
        choices=("true", "wheel"),
    )
    wheel_noise_m: float = param(
        0.0,
        "stddev of a wheel's measured travel after a metre; grows with the way's root",
        unit="m",
        at_least=0.0,
        at_most=0.5,
    )
    lidar_noise_m: float = param(
        -1.0, "stddev of ranges; -1 = as the robot's file says", unit="m", at_least=-1.0
    )
    lidar_dropout: float = param(
        0.0, "share of beams that return nothing valid", at_least=0.0, at_most=1.0
    )
    camera_renderer: str = param(
        "raycast",
        "how images are made: by ray casting, by OpenGL, or OpenGL where it works",
        choices=("raycast", "gl", "auto"),
    )

    map_frame: str = param("map", "the world's frame")
    odom_frame: str = param("odom", "frame of odometry; may equal map_frame")
    base_frame: str = param(
        "base_link", "midway between the drive wheels, on the floor"
    )
    odometry_child_frame: str = param(
        "", "frame whose pose /odom/filtered carries; empty = base_frame"
    )
    link_frame_prefix: str = param("", "put before link names to make their frames")

    clock_rate_hz: float = param(100.0, "/clock", unit="Hz", above=0.0, at_most=1000.0)
    odometry_rate_hz: float = param(
        50.0, "/odom/filtered and /ground_truth", unit="Hz", above=0.0, at_most=500.0
    )
    tf_rate_hz: float = param(
        50.0, "/tf of the base", unit="Hz", above=0.0, at_most=50.0
    )
    joint_tf_rate_hz: float = param(
        10.0, "/tf of turning wheels", unit="Hz", above=0.0, at_most=50.0
    )

    def check(self) -> None:
        steps = CONTROL_PERIOD_S / self.timestep_s
        if abs(steps - round(steps)) > 1e-6:
            raise ParameterError(
                f"parameter 'timestep_s': {self.timestep_s!r} is not allowed; "
                f"wanted {CONTROL_PERIOD_S} s divided by a whole number"
            )


# What the simulator or its topics are built from: changing it needs a new start.
FIXED_AT_START = frozenset(
    {
        *("timestep_s", "seed", "camera_renderer", "odometry", "wheel_noise_m"),
        *("map_frame", "odom_frame", "base_frame", "odometry_child_frame"),
        *("link_frame_prefix", "clock_rate_hz", "odometry_rate_hz", "tf_rate_hz"),
        "joint_tf_rate_hz",
    }
)
