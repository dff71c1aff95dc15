"""Parameters of the control stage."""

import math
from dataclasses import dataclass

from navette.errors import ParameterError
from navette.geometry import OMNI
from navette.navigation.control.methods import CONTROLLERS
from navette.navigation.shared_params import (
    BendParams,
    MotionParams,
    acceleration_limit,
    speed_limit,
)
from navette.params import param


@dataclass(frozen=True, kw_only=True)
class ControlParams(BendParams, MotionParams):
    """Limits, path tracking, collision check and timeouts of the controller."""

    method: str = param("pure_pursuit", "steering method", choices=CONTROLLERS)

    cruise_speed_mps: float = speed_limit(0.5, "speed on a straight, free path")
    reverse_speed_mps: float = speed_limit(
        0.3, "speed on a straight, free path driven backwards"
    )
    max_speed_mps: float = speed_limit(
        2.0, "limit of the commanded speed, forward and reverse"
    )
    max_turn_rate_radps: float = speed_limit(1.0, "limit of the commanded turn rate")
    max_side_speed_mps: float = param(
        0.0, "omni: limit of the speed to the left and to the right", at_least=0.0
    )
    steering_time_s: float = param(
        0.2, "ackermann: time from straight to the sharpest bend", above=0.0
    )
    acceleration_mps2: float = acceleration_limit(
        1.0, "limit on increasing the commanded speed"
    )
    deceleration_mps2: float = acceleration_limit(
        1.0, "limit on decreasing the commanded speed"
    )
    turn_acceleration_radps2: float = acceleration_limit(
        2.0, "limit on changing the commanded turn rate"
    )
    lateral_acceleration_mps2: float = acceleration_limit(
        1.0, "limit of speed² · curvature in bends"
    )
    wheel_separation_m: float = param(
        0.0, "distance between the drive wheels; 0: no wheel-speed limit", at_least=0.0
    )
    max_wheel_speed_mps: float = param(
        0.0, "limit of a drive wheel's rim speed; 0: no limit", at_least=0.0
    )

    lookahead_m: float = param(
        1.0, "arc length from the robot to the carrot", above=0.0
    )
    lookahead_time_s: float = param(
        0.0, "lookahead grows to speed times this; 0: fixed", at_least=0.0
    )
    lookahead_min_m: float = param(
        0.35, "least lookahead, in the sharpest bends", above=0.0
    )
    path_tolerance_m: float = param(
        0.05, "deviation allowed when rounding corners", above=0.0
    )
    pid_kp_per_m2: float = param(2.5, "curvature per cross-track error", at_least=0.0)
    pid_ki_per_m3: float = param(
        0.4, "curvature per cross-track error times metres", at_least=0.0
    )
    pid_kd_per_m: float = param(
        2.5, "curvature per heading error (= slope of the error)", at_least=0.0
    )

    rotate_above_rad: float = param(
        0.6,
        "heading error above which the robot turns in place first",
        above=0.1,
        at_most=math.pi,
    )
    corner_rotate_rad: float = param(
        0.9,
        "corner angle above which the robot turns in place",
        above=0.1,
        at_most=math.pi,
    )
    turn_tolerance_rad: float = param(
        0.04,
        "heading error at which a turn in place is complete",
        above=0.0,
        at_most=0.3,
    )
    goal_tolerance_m: float = param(
        0.1, "distance to the path's end at which it is reached", above=0.0
    )
    max_deviation_m: float = param(
        1.0, "distance from the path at which the robot stops (off_path)", above=0.0
    )

    collision_check: bool = param(True, "check each command against the latest costmap")
    collision_margin_m: float = param(
        0.025, "clearance that every commanded motion keeps", at_least=0.0
    )
    moving_clearance_m: float = param(
        0.4,
        "distance from moving obstacles below which the robot avoids or yields",
        at_least=0.0,
    )
    evasion_factor: float = param(
        1.0,
        "mppi: factor of reverse speed, turn rate and accelerations near moving "
        "obstacles",
        at_least=1.0,
        at_most=10.0,
    )

    mppi_samples: int = param(
        265, "mppi: command sequences tried per step", at_least=50, at_most=10_000
    )
    mppi_steps: int = param(28, "mppi: predicted steps", at_least=5, at_most=200)
    mppi_step_s: float = param(
        0.1, "mppi: time of a predicted step", at_least=0.02, at_most=0.5
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
        0.25, "mppi: clearance below which it costs", at_least=0.01, at_most=10.0
    )
    mppi_reverse_weight: float = param(
        5.0, "mppi: cost of driving against the path's direction", at_least=0.0
    )
    mppi_effort_weight: float = param(
        0.02, "mppi: cost of changing the turn rate", at_least=0.0
    )

    planner_timeout_s: float = param(
        2.0,
        "no /path or /planner/status for this long stops the robot; 0: never",
        at_least=0.0,
    )
    failure_tolerance_s: float = param(
        2.0,
        "follow_path fails after this long blocked, off the path or with stale inputs",
        at_least=0.0,
    )
    progress_distance_m: float = param(
        0.3, "motion that counts as progress of follow_path", above=0.0
    )
    progress_angle_rad: float = param(
        0.3, "turn that counts as progress of follow_path", above=0.0
    )
    progress_timeout_s: float = param(
        10.0,
        "follow_path fails after this long without progress; 0: never",
        at_least=0.0,
    )
    idle_zeros: int = param(
        5,
        "zero commands published after the robot came to rest",
        at_least=1,
        at_most=1_000_000,
    )

    def check(self) -> None:
        super().check()
        if max(self.cruise_speed_mps, self.reverse_speed_mps) > self.max_speed_mps:
            raise ParameterError(
                f"cruise_speed_mps {self.cruise_speed_mps:g} and reverse_speed_mps "
                f"{self.reverse_speed_mps:g}: must be <= max_speed_mps "
                f"{self.max_speed_mps:g}"
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
