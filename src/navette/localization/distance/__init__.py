"""Distance travelled: positions or velocities in, metres out."""

from navette.localization.distance.odometer import Odometer, Step
from navette.localization.distance.params import DistanceParams

__all__ = ["DistanceParams", "Odometer", "Step"]
