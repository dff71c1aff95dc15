"""Where the robot is, and how far it has come."""

from navette.navigation.localization.distance import DistanceParams, Odometer, Step
from navette.navigation.localization.ekf import (
    EkfParams,
    Estimate,
    Fused,
    Measurement,
    OrderedEkf,
    PlanarEkf,
)

__all__ = [
    # how far
    "DistanceParams",
    "Odometer",
    "Step",
    # where
    "EkfParams",
    "Estimate",
    "Fused",
    "Measurement",
    "OrderedEkf",
    "PlanarEkf",
]
