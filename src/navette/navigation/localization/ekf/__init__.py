"""Pose estimate: an extended Kalman filter over odometry, IMU and GNSS."""

from navette.navigation.localization.ekf.filter import Estimate, Fused, PlanarEkf
from navette.navigation.localization.ekf.history import OrderedEkf
from navette.navigation.localization.ekf.measurement import Measurement
from navette.navigation.localization.ekf.params import EkfParams

__all__ = ["EkfParams", "Estimate", "Fused", "Measurement", "OrderedEkf", "PlanarEkf"]
