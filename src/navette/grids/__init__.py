"""Grid arrays: cells, rays, distance, inflation, resampling."""

from navette.grids.cells import FREE, LETHAL, UNKNOWN
from navette.grids.clearance import (
    body_clearance,
    body_points,
    distance_at,
    grid_frame,
    pose_clearance,
    pose_is_clear,
)
from navette.grids.compare import Changes, compare
from navette.grids.distance import distance_field, distance_squared
from navette.grids.inflation import cost_table, inflate
from navette.grids.rays import beam_directions, trace_beams
from navette.grids.resample import accumulate, merge, placed
from navette.grids.spec import GridSpec

__all__ = [
    "GridSpec",
    "grid_frame",
    "UNKNOWN",
    "FREE",
    "LETHAL",
    "distance_squared",
    "distance_field",
    "body_points",
    "body_clearance",
    "distance_at",
    "pose_clearance",
    "pose_is_clear",
    "cost_table",
    "inflate",
    "beam_directions",
    "trace_beams",
    "merge",
    "accumulate",
    "placed",
    "Changes",
    "compare",
]
