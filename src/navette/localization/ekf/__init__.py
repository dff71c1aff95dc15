"""Where the robot is: an extended Kalman filter over what its sensors say."""

from navette.localization.ekf.filter import Estimate, Fused, PlanarEkf
from navette.localization.ekf.history import OrderedEkf
from navette.localization.ekf.measurement import Measurement
from navette.localization.ekf.params import EkfParams

__all__ = ["EkfParams", "Estimate", "Fused", "Measurement", "OrderedEkf", "PlanarEkf"]
