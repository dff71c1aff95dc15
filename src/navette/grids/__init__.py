"""Grid arrays: cells, rays, distance, inflation, resampling."""

from navette.grids.clearance import (
    body_clearance,
    body_points,
    distance_at,
    grid_frame,
    pose_clearance,
    pose_is_clear,
)
from navette.grids.distance import distance_field, distance_squared
from navette.grids.spec import GridSpec

__all__ = [
    "GridSpec",
    "grid_frame",
    "distance_squared",
    "distance_field",
    "body_points",
    "body_clearance",
    "distance_at",
    "pose_clearance",
    "pose_is_clear",
]
