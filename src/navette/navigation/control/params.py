"""Parameters of the control stage."""

import math
from dataclasses import dataclass

from navette.errors import InvalidValueError, ParameterError
from navette.geometry import ACKERMANN, DIFFERENTIAL, DRIVES, OMNI, Footprint
from navette.navigation.control.methods import CONTROLLERS
from navette.navigation.motion_params import (
    acceleration_limit,
    speed_limit,
    turn_acceleration_limit,
    turn_rate_limit,
)
from navette.params import Params, param


@dataclass(frozen=True, kw_only=True)
class ControlParams(Params):
    """Limits, path tracking, collision check and timeouts of the controller."""

    map_frame: str = param("map", "frame of /path and of the pose that is steered")
    base_frame: str = param("base_link", "frame that is steered: the axle's midpoint")
    method: str = param("pure_pursuit", "steering method", choices=CONTROLLERS)
    rate_hz: float = param(
        20.0, "commands per second", unit="Hz", at_least=10.0, at_most=1000.0
    )

    drive: str = param(
        DIFFERENTIAL,
        "motions of the base: turns in place, bends of a least radius (ackermann), or "
        "sideways, too (omni)",
        choices=DRIVES,
    )
    cruise_speed_mps: float = speed_limit(0.5, "speed on a straight, free path")
    reverse_speed_mps: float = speed_limit(
        0.3, "speed on a straight, free path driven backwards"
    )
    max_speed_mps: float = speed_limit(
        2.0, "limit of the commanded speed, forward and reverse"
    )
    max_turn_rate_radps: float = turn_rate_limit(
        1.0, "limit of the commanded turn rate"
    )
    max_side_speed_mps: float = param(
        0.0, "omni: limit of the speed to the left and to the right", unit="m/s",
        at_least=0.0,
    )  # fmt: skip
    min_turning_radius_m: float = param(
        0.0, "ackermann: least radius of a bend", unit="m", at_least=0.0
    )
    steering_time_s: float = param(
        0.2, "ackermann: time from straight to the sharpest bend", unit="s", above=0.0
    )
    acceleration_mps2: float = acceleration_limit(
        1.0, "limit on increasing the commanded speed"
    )
    deceleration_mps2: float = acceleration_limit(
        1.0, "limit on decreasing the commanded speed"
    )
    turn_acceleration_radps2: float = turn_acceleration_limit(
        2.0, "limit on changing the commanded turn rate"
    )
    lateral_acceleration_mps2: float = acceleration_limit(
        1.0, "limit of speed² · curvature in bends"
    )
    wheel_separation_m: float = param(
        0.0,
        "distance between the drive wheels; 0: no wheel-speed limit",
        unit="m",
        at_least=0.0,
    )
    max_wheel_speed_mps: float = param(
        0.0, "limit of a drive wheel's rim speed; 0: no limit", unit="m/s", at_least=0.0
    )

    lookahead_m: float = param(
        1.0, "arc length from the robot to the carrot", unit="m", above=0.0
    )
    lookahead_time_s: float = param(
        0.0, "lookahead grows to speed times this; 0: fixed", unit="s", at_least=0.0
    )
    lookahead_min_m: float = param(
        0.35, "least lookahead, in the sharpest bends", unit="m", above=0.0
    )
    path_tolerance_m: float = param(
        0.05, "deviation allowed when rounding corners", unit="m", above=0.0
    )
    pid_kp_per_m2: float = param(
        2.5, "curvature per cross-track error", unit="1/m²", at_least=0.0
    )
    pid_ki_per_m3: float = param(
        0.4, "curvature per cross-track error times metres", unit="1/m³", at_least=0.0
    )
    pid_kd_per_m: float = param(
        2.5, "curvature per heading error (= slope of the error)", unit="1/m",
        at_least=0.0,
    )  # fmt: skip

    rotate_above_rad: float = param(
        0.6, "heading error above which the robot turns in place first", unit="rad",
        above=0.1, at_most=math.pi,
    )  # fmt: skip
    corner_rotate_rad: float = param(
        0.9, "corner angle above which the robot turns in place", unit="rad",
        above=0.1, at_most=math.pi,
    )  # fmt: skip
    turn_tolerance_rad: float = param(
        0.04, "heading error at which a turn in place is complete", unit="rad",
        above=0.0, at_most=0.3,
    )  # fmt: skip
    goal_tolerance_m: float = param(
        0.1, "distance to the path's end at which it is reached", unit="m",
        above=0.0,
    )  # fmt: skip
    max_deviation_m: float = param(
        1.0,
        "distance from the path at which the robot stops (off_path)",
        unit="m",
        above=0.0,
    )

    footprint_m: tuple[float, ...] = param(
        (0.25, 0.2, -0.25, 0.2, -0.25, -0.2, 0.25, -0.2),
        "outline of the body about the axle: x1, y1, x2, y2, …", unit="m",
    )  # fmt: skip
    collision_check: bool = param(True, "check each command against the latest costmap")
    collision_margin_m: float = param(
        0.025, "clearance that every commanded motion keeps", unit="m", at_least=0.0
    )
    blind_reverse_m: float = param(
        0.1,
        "how far the body may leave its outline, where the robot was put down, into "
        "space behind it that no beam has seen, backing up and turning: a hand's width",
        unit="m",
        at_least=0.0,
        at_most=10.0,
    )
    moving_clearance_m: float = param(
        0.4, "distance from moving obstacles below which the robot avoids or yields",
        unit="m", at_least=0.0,
    )  # fmt: skip
    evasion_factor: float = param(
        1.0,
        "mppi: factor of reverse speed, turn rate and accelerations near moving "
        "obstacles",
        at_least=1.0,
        at_most=10.0,
    )
    reaction_s: float = param(
        0.2, "delay from command to motion", unit="s", at_least=0.0
    )
    lethal_cost: int = param(
        100, "costmap value from which a cell is an obstacle", at_least=1, at_most=100
    )

    mppi_samples: int = param(
        265, "mppi: command sequences tried per step", at_least=50, at_most=10_000
    )
    mppi_steps: int = param(28, "mppi: predicted steps", at_least=5, at_most=200)
    mppi_step_s: float = param(
        0.1, "mppi: time of a predicted step", unit="s", at_least=0.02, at_most=0.5
    )
    mppi_temperature: float = param(
        0.3, "mppi: cost difference that matters", at_least=0.001
    )
    mppi_align_weight: float = param(
        6.0, "mppi: cost of the squared distance from the path", at_least=0.0
    )
    mppi_heading_weight: float = param(
        0.6, "mppi: cost of the squared heading error", at_least=0.0
    )
    mppi_progress_weight: float = param(
        4.0, "mppi: cost of a metre of path not driven", at_least=0.0
    )
    mppi_clearance_weight: float = param(
        6.0, "mppi: cost of low clearance", at_least=0.0
    )
    mppi_clearance_m: float = param(
        0.25, "mppi: clearance below which it costs", unit="m", at_least=0.01,
        at_most=10.0,
    )  # fmt: skip
    mppi_reverse_weight: float = param(
        5.0, "mppi: cost of driving against the path's direction", at_least=0.0
    )
    mppi_effort_weight: float = param(
        0.02, "mppi: cost of changing the turn rate", at_least=0.0
    )

    odometry_timeout_s: float = param(
        0.14, "least age of odometry that stops the robot", unit="s", above=0.0
    )
    costmap_timeout_s: float = param(
        0.19, "least age of the costmap that stops the robot", unit="s", above=0.0
    )
    stale_periods: float = param(
        3.2,
        "odometry and costmap are stale after this many of their measured periods (up "
        "to 0.42 s), if that is longer than their timeouts",
        at_least=1.0,
        at_most=100.0,
    )
    planner_timeout_s: float = param(
        2.0, "no /path or /planner/status for this long stops the robot; 0: never",
        unit="s", at_least=0.0,
    )  # fmt: skip
    failure_tolerance_s: float = param(
        2.0,
        "follow_path fails after this long blocked, off the path or with stale inputs",
        unit="s", at_least=0.0,
    )  # fmt: skip
    progress_distance_m: float = param(
        0.3, "motion that counts as progress of follow_path", unit="m", above=0.0
    )
    progress_angle_rad: float = param(
        0.3, "turn that counts as progress of follow_path", unit="rad", above=0.0
    )
    progress_timeout_s: float = param(
        10.0, "follow_path fails after this long without progress; 0: never", unit="s",
        at_least=0.0,
    )  # fmt: skip
    stall_time_s: float = param(
        0.3,
        "no motion for this long, though commanded, stops the robot; 0: never",
        unit="s",
        at_least=0.0,
        at_most=10.0,
    )
    idle_zeros: int = param(
        5, "zero commands published after the robot came to rest", at_least=1,
        at_most=1_000_000,
    )  # fmt: skip

    def check(self) -> None:
        if max(self.cruise_speed_mps, self.reverse_speed_mps) > self.max_speed_mps:
            raise ParameterError(
                f"cruise_speed_mps {self.cruise_speed_mps:g} and reverse_speed_mps "
                f"{self.reverse_speed_mps:g}: must be <= max_speed_mps "
                f"{self.max_speed_mps:g}"
            )
        if (self.drive == ACKERMANN) != (self.min_turning_radius_m > 0):
            raise ParameterError(
                f"min_turning_radius_m {self.min_turning_radius_m:g}: must be > 0 with "
                f"drive {ACKERMANN!r} and 0 with others; drive is {self.drive!r}"
            )
        if (self.drive == OMNI) != (self.max_side_speed_mps > 0):
            raise ParameterError(
                f"max_side_speed_mps {self.max_side_speed_mps:g}: must be > 0 with "
                f"drive {OMNI!r} and 0 with others; drive is {self.drive!r}"
            )
        if self.lookahead_min_m > self.lookahead_m:
            raise ParameterError(
                f"lookahead_min_m {self.lookahead_min_m:g}: must be <= lookahead_m "
                f"{self.lookahead_m:g}"
            )
        try:
            Footprint.from_flat(self.footprint_m)
        except InvalidValueError as error:
            raise ParameterError(f"parameter 'footprint_m': {error}") from error
