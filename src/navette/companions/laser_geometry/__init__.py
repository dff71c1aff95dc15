"""laser_geometry: scans as point clouds."""

from navette.companions.laser_geometry.laser_geometry import LaserProjection

__all__ = ["LaserProjection"]
