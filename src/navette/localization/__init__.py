"""Where the robot is, and how far it has come."""

from navette.localization.distance.odometer import Odometer, Step
from navette.localization.distance.params import DistanceParams

__all__ = ["DistanceParams", "Odometer", "Step"]
