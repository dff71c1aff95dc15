"""Localization: pose estimate (EKF) and distance travelled."""

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
    "DistanceParams",
    "Odometer",
    "Step",
    "EkfParams",
    "Estimate",
    "Fused",
    "Measurement",
    "OrderedEkf",
    "PlanarEkf",
]
