"""Behaviors: short motions on request, checked against the newest costmap."""

from navette.navigation.behaviors.motions import (
    DriveStraight,
    MeasuredMotion,
    Motion,
    Target,
    TurnBy,
)
from navette.navigation.behaviors.params import BehaviorParams
from navette.navigation.behaviors.runner import (
    AssistedTeleop,
    Behavior,
    BehaviorEnd,
    BehaviorInputs,
    BehaviorStep,
    MotionBehavior,
    Waiting,
)

__all__ = [
    "AssistedTeleop",
    "Behavior",
    "BehaviorEnd",
    "BehaviorInputs",
    "BehaviorParams",
    "BehaviorStep",
    "DriveStraight",
    "MeasuredMotion",
    "Motion",
    "MotionBehavior",
    "Target",
    "TurnBy",
    "Waiting",
]
