"""Grid arrays: cells, rays, distance, inflation, resampling."""

from navette.navigation.grids.alignment import placed
from navette.navigation.grids.clearance import (
    Body,
    DistanceGrid,
    body_clearance,
    body_points,
    distance_at,
    make_body,
    pose_clearance,
    pose_is_clear,
)
from navette.navigation.grids.collision_check import (
    NONE_UNSEEN,
    CollisionCheck,
    MovingBody,
)
from navette.navigation.grids.compare import MapComparison
from navette.navigation.grids.distance import distance_field
from navette.navigation.grids.distance_levels import (
    DistanceLevels,
    distance_levels,
    level_metres,
    level_type,
)
from navette.navigation.grids.evidence import accumulate
from navette.navigation.grids.exact_clearance import (
    ObstacleGrid,
    Outline,
    body_distance,
    bounding_box,
    exact_clearance,
    exact_clearances,
    make_obstacles,
    make_outline,
    off_box,
    signed_distance,
)
from navette.navigation.grids.floor_echoes import LEVEL, Upward, is_floor, upward_of
from navette.navigation.grids.footprint_cells import cells_in_footprint
from navette.navigation.grids.hit_points import (
    HitPoints,
    points_from_message,
    points_to_message,
)
from navette.navigation.grids.inflation import cost_table, inflate
from navette.navigation.grids.marked_cells import MarkedCells, marked_cells
from navette.navigation.grids.merge import merge
from navette.navigation.grids.messages import (
    grid_from_message,
    grid_to_message,
    resize_grid_message,
    update_grid_message,
    window_from_message,
    window_to_message,
)
from navette.navigation.grids.moving_discs import (
    NO_DISCS,
    MovingDiscs,
    disc_outlines,
    discs_from_message,
    inside_discs,
    without_discs,
)
from navette.navigation.grids.obstacle_points import obstacle_points
from navette.navigation.grids.obstacle_trial import load_obstacle_kernels
from navette.navigation.grids.obstacles import (
    Obstacles,
    ObstacleTracker,
)
from navette.navigation.grids.own_cells import checked_cells
from navette.navigation.grids.planar_scan import PlanarScan
from navette.navigation.grids.rays import beam_directions, trace_beams
from navette.navigation.grids.received_map import (
    NO_PART,
    MapPart,
    MapReader,
    ReceivedMap,
)
from navette.navigation.grids.regions import SquareRegion
from navette.navigation.grids.shared_cells import SharedCells
from navette.navigation.grids.sparse import (
    GrowthMemory,
    RowSpans,
    SparseGrid,
    copied,
    padded,
    sparse_zeros,
)
from navette.navigation.grids.spec import FREE, LETHAL, UNKNOWN, GridSpec, grid_frame
from navette.navigation.grids.sub_cells import (
    cell_points,
    mark_points,
    point_radius,
)
from navette.navigation.grids.unseen import (
    Layer,
    StartArea,
    unseen_mask,
    unseen_points,
)
from navette.navigation.grids.windows import NO_CELLS, CellWindow

__all__ = [
    "LEVEL",
    "Upward",
    "is_floor",
    "upward_of",
    "CellWindow",
    "NO_CELLS",
    "RowSpans",
    "SparseGrid",
    "copied",
    "padded",
    "sparse_zeros",
    "MapPart",
    "MapReader",
    "ReceivedMap",
    "SharedCells",
    "SquareRegion",
    "NO_DISCS",
    "NO_PART",
    "MovingDiscs",
    "PlanarScan",
    "disc_outlines",
    "discs_from_message",
    "inside_discs",
    "without_discs",
    "GridSpec",
    "GrowthMemory",
    "grid_frame",
    "UNKNOWN",
    "FREE",
    "LETHAL",
    "distance_field",
    "distance_levels",
    "level_metres",
    "level_type",
    "DistanceLevels",
    "DistanceGrid",
    "Body",
    "make_body",
    "body_points",
    "body_clearance",
    "distance_at",
    "pose_clearance",
    "pose_is_clear",
    "Outline",
    "ObstacleGrid",
    "make_outline",
    "load_obstacle_kernels",
    "make_obstacles",
    "exact_clearance",
    "exact_clearances",
    "body_distance",
    "signed_distance",
    "bounding_box",
    "off_box",
    "cost_table",
    "inflate",
    "beam_directions",
    "trace_beams",
    "merge",
    "accumulate",
    "placed",
    "cells_in_footprint",
    "checked_cells",
    "MapComparison",
    "CollisionCheck",
    "MovingBody",
    "Obstacles",
    "ObstacleTracker",
    "obstacle_points",
    "NONE_UNSEEN",
    "Layer",
    "StartArea",
    "unseen_mask",
    "unseen_points",
    "HitPoints",
    "points_to_message",
    "points_from_message",
    "mark_points",
    "MarkedCells",
    "marked_cells",
    "cell_points",
    "point_radius",
    "grid_to_message",
    "resize_grid_message",
    "update_grid_message",
    "window_from_message",
    "window_to_message",
    "grid_from_message",
]
