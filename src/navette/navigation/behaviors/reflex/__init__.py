"""Reflex: a contact in, commands that stop the robot and back it off out."""

from navette.navigation.behaviors.reflex.params import ReflexParams
from navette.navigation.behaviors.reflex.reflex import BumperReflex

__all__ = ["BumperReflex", "ReflexParams"]
