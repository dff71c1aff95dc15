"""laser_geometry: scans as point clouds."""

from navette.ros2.packages.laser_geometry.laser_geometry import LaserProjection

__all__ = ["LaserProjection"]
