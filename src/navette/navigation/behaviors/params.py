"""Parameters of the behaviors."""

from dataclasses import dataclass

from navette.geometry import Footprint
from navette.navigation.grids import MovingBody
from navette.navigation.shared_params import (
    MotionParams,
    acceleration_limit,
    speed_limit,
)
from navette.params import param


@dataclass(frozen=True, kw_only=True)
class BehaviorParams(MotionParams):
    """Limits, collision check and timeouts of the behaviors."""

    max_speed_mps: float = speed_limit(0.5, "limit of the requested speed")
    max_turn_rate_radps: float = speed_limit(1.0, "speed of a spin")
    acceleration_mps2: float = acceleration_limit(0.5, "limit on increasing the speed")
    deceleration_mps2: float = acceleration_limit(0.5, "limit on decreasing the speed")
    turn_acceleration_radps2: float = acceleration_limit(
        1.5, "limit on changing the turn rate"
    )
    distance_tolerance_m: float = param(
        0.01, "missing distance at which a drive is complete", above=0.0
    )
    yaw_tolerance_rad: float = param(
        0.02, "missing angle at which a spin is complete", above=0.0
    )

    collision_margin_m: float = param(
        0.05, "clearance that every motion keeps", at_least=0.0
    )
    simulate_ahead_s: float = param(
        2.0,
        "motion that must be free; else the behavior fails (COLLISION_AHEAD)",
        above=0.0,
    )

    failure_tolerance_s: float = param(
        1.0, "a behavior fails after this long with stale inputs", at_least=0.0
    )
    teleop_timeout_s: float = param(
        0.5, "age at which assisted_teleop drops a command", above=0.0
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
