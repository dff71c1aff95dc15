"""Behaviors: short motions on request, checked against the newest costmap."""

from navette.navigation.behaviors.motions import (
    BaseMotion,
    DriveStraight,
    MeasuredMotion,
    TurnBy,
    VelocityTarget,
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
    "BaseMotion",
    "MotionBehavior",
    "VelocityTarget",
    "TurnBy",
    "Waiting",
]
