"""Distance travelled: positions or velocities in, metres out."""

from navette.navigation.localization.distance.odometer import Odometer, Step
from navette.navigation.localization.distance.params import DistanceParams

__all__ = ["DistanceParams", "Odometer", "Step"]
