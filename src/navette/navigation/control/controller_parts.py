"""Parts of the controller that all pieces of all paths share."""

from dataclasses import dataclass
from typing import Self

from navette.geometry import Footprint
from navette.navigation.control.params import ControlParams
from navette.navigation.control.steering import Steering, make_steering
from navette.navigation.control.turn_gain import TurnGain
from navette.navigation.grids import CollisionCheck, MovingBody

# Clearance beyond which the exact value is not published.
_REPORTED_M = 0.3


@dataclass(frozen=True)
class TurnParts:
    """Parameters and the stateful parts that a turn in place needs."""

    params: ControlParams
    collision: CollisionCheck
    turn_gain: TurnGain

    @classmethod
    def of(cls, params: ControlParams) -> Self:
        return cls(params, collision_check(params), TurnGain())


@dataclass(frozen=True)
class ControllerParts(TurnParts):
    """Parameters and stateful parts; built once for a set of parameters."""

    steering: Steering

    @classmethod
    def of(cls, params: ControlParams) -> Self:
        check = collision_check(params)
        return cls(params, check, TurnGain(), make_steering(params))


def collision_check(params: ControlParams) -> CollisionCheck:
    """Return the check of commands against the obstacles."""
    body = MovingBody(
        footprint=Footprint.from_flat(params.footprint_m),
        margin_m=params.collision_margin_m,
        horizon_m=_REPORTED_M,
        reaction_s=params.reaction_s,
        deceleration_mps2=params.deceleration_mps2,
        turn_acceleration_radps2=params.turn_acceleration_radps2,
    )
    return CollisionCheck(body)
