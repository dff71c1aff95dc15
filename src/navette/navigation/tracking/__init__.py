"""Velocities of what moves around the robot, from its scans."""

from navette.navigation.tracking.params import TrackingParams
from navette.navigation.tracking.tracker import MovingObstacles
from navette.navigation.tracking.tracks import TrackedObstacle

__all__ = ["MovingObstacles", "TrackedObstacle", "TrackingParams"]
