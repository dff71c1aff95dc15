"""Distance travelled, from positions or velocities."""

from navette.navigation.localization.distance.odometer import Odometer, Step
from navette.navigation.localization.distance.params import DistanceParams

__all__ = ["DistanceParams", "Odometer", "Step"]
