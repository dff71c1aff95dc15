"""Grid arrays: cells, rays, distance, inflation, resampling."""

from navette.grids.alignment import placed
from navette.grids.clearance import (
    Body,
    DistanceGrid,
    body_clearance,
    body_points,
    distance_at,
    make_body,
    pose_clearance,
    pose_is_clear,
)
from navette.grids.compare import Changes, compare
from navette.grids.distance import distance_field
from navette.grids.evidence import accumulate
from navette.grids.footprint_cells import cells_in_footprint
from navette.grids.inflation import cost_table, inflate
from navette.grids.merge import merge
from navette.grids.messages import grid_from_message, grid_to_message
from navette.grids.rays import beam_directions, trace_beams
from navette.grids.spec import FREE, LETHAL, UNKNOWN, GridSpec, grid_frame

__all__ = [
    "GridSpec",
    "grid_frame",
    "UNKNOWN",
    "FREE",
    "LETHAL",
    "distance_field",
    "DistanceGrid",
    "Body",
    "make_body",
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
    "cells_in_footprint",
    "Changes",
    "compare",
    "grid_to_message",
    "grid_from_message",
]
