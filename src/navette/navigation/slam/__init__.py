"""SLAM: scans and odometry in, a map and the pose in it out."""

from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.slam import Slam, SlamEstimate

__all__ = ["SlamParams", "Slam", "SlamEstimate"]
