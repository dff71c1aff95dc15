"""Parameters of the behaviors."""

from dataclasses import dataclass

from navette.errors import InvalidValueError, ParameterError
from navette.geometry import DIFFERENTIAL, DRIVES, Footprint
from navette.navigation.grids import MovingBody
from navette.navigation.motion_params import (
    acceleration_limit,
    speed_limit,
    turn_acceleration_limit,
    turn_rate_limit,
)
from navette.params import Params, param


@dataclass(frozen=True, kw_only=True)
class BehaviorParams(Params):
    """Limits, collision check and timeouts of the behaviors."""

    map_frame: str = param("map", "frame of the pose in which motion is measured")
    base_frame: str = param("base_link", "frame that moves: the axle's midpoint")
    rate_hz: float = param(
        20.0, "commands per second", unit="Hz", at_least=10.0, at_most=1000.0
    )

    drive: str = param(
        DIFFERENTIAL,
        "motions of the base; a spin is refused with ackermann",
        choices=DRIVES,
    )
    max_speed_mps: float = speed_limit(0.5, "limit of the requested speed")
    max_turn_rate_radps: float = turn_rate_limit(1.0, "speed of a spin")
    acceleration_mps2: float = acceleration_limit(0.5, "limit on increasing the speed")
    deceleration_mps2: float = acceleration_limit(0.5, "limit on decreasing the speed")
    turn_acceleration_radps2: float = turn_acceleration_limit(
        1.5, "limit on changing the turn rate"
    )
    distance_tolerance_m: float = param(
        0.01, "missing distance at which a drive is complete", unit="m", above=0.0
    )
    yaw_tolerance_rad: float = param(
        0.02, "missing angle at which a spin is complete", unit="rad", above=0.0
    )

    footprint_m: tuple[float, ...] = param(
        (0.25, 0.2, -0.25, 0.2, -0.25, -0.2, 0.25, -0.2),
        "outline of the body about the axle: x1, y1, x2, y2, …", unit="m",
    )  # fmt: skip
    collision_margin_m: float = param(
        0.05, "clearance that every motion keeps", unit="m", at_least=0.0
    )
    simulate_ahead_s: float = param(
        2.0, "motion that must be free; else the behavior fails (COLLISION_AHEAD)",
        unit="s", above=0.0,
    )  # fmt: skip
    blind_reverse_m: float = param(
        0.1,
        "how far the body may leave its outline, where the robot was put down, into "
        "space behind it that no beam has seen, backing up and turning: a hand's width",
        unit="m",
        at_least=0.0,
        at_most=10.0,
    )
    reaction_s: float = param(
        0.2, "delay from command to motion", unit="s", at_least=0.0
    )
    lethal_cost: int = param(
        100, "costmap value from which a cell is an obstacle", at_least=1, at_most=100
    )

    odometry_timeout_s: float = param(
        0.25, "least age of odometry that stops the robot", unit="s", above=0.0
    )
    costmap_timeout_s: float = param(
        0.3, "least age of the costmap that stops the robot", unit="s", above=0.0
    )
    stale_periods: float = param(
        3.2,
        "odometry and costmap are stale after this many of their measured periods (up "
        "to 0.42 s), if that is longer than their timeouts",
        at_least=1.0,
        at_most=100.0,
    )
    failure_tolerance_s: float = param(
        1.0, "a behavior fails after this long with stale inputs", unit="s",
        at_least=0.0,
    )  # fmt: skip
    stall_time_s: float = param(
        0.3,
        "no motion for this long, though commanded, ends a behavior; 0: never",
        unit="s",
        at_least=0.0,
        at_most=10.0,
    )
    teleop_timeout_s: float = param(
        0.5, "age at which assisted_teleop drops a command", unit="s", above=0.0
    )

    def body(self) -> MovingBody:
        """Return the body for the collision check."""
        return MovingBody(
            footprint=Footprint.from_flat(self.footprint_m),
            margin_m=self.collision_margin_m,
            horizon_m=self.collision_margin_m,
            reaction_s=self.reaction_s,
            deceleration_mps2=self.deceleration_mps2,
            turn_acceleration_radps2=self.turn_acceleration_radps2,
        )

    def check(self) -> None:
        try:
            Footprint.from_flat(self.footprint_m)
        except InvalidValueError as error:
            raise ParameterError(f"parameter 'footprint_m': {error}") from error
