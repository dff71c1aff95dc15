"""Obstacle points around the robot, from the newest costmap."""

import math
from functools import partial
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Footprint, Pose2
from navette.geometry.messages import stamp_of
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.sensor_msgs.msg import PointCloud2
from navette.navigation.grids.alignment import placed
from navette.navigation.grids.hit_points import HitPoints
from navette.navigation.grids.map_obstacles import MapObstacles, Region
from navette.navigation.grids.merge import merge
from navette.navigation.grids.messages import grid_from_message
from navette.navigation.grids.obstacle_points import obstacle_points, points_within
from navette.navigation.grids.received_map import MapPart, ReceivedMap
from navette.navigation.grids.spec import UNKNOWN, Cells, GridSpec
from navette.navigation.grids.sub_cells import point_radius
from navette.navigation.grids.unseen import (
    FARTHEST_M,
    Layer,
    StartArea,
    unseen_points,
)
from navette.navigation.grids.windows import NO_CELLS, CellWindow

# Half the edge of the square in which it matters that an earlier map was seen; the
# robot drives a little before the next map.
_NEAR_M = FARTHEST_M + 2.0
_SAME_CELLS = 1e-3  # largest shift of cells, in cells, at which they are the same


class RobotPoses(Protocol):
    """Poses of the robot over time, in the map frame."""

    map_frame: str

    @property
    def first(self) -> Pose2 | None:
        """Return map_T_base where the robot was put down."""

    def predicted_at(self, stamp_ns: int) -> Pose2 | None:
        """Return map_T_base at a stamp, interpolated or predicted."""

    def predicted_now(self, now_ns: int) -> Pose2 | None:
        """Return map_T_base now."""

    def transform_to_base(self, frame_id: str) -> Pose2 | None:
        """Return base_T_frame of a frame fixed to the robot."""


class Obstacles(NamedTuple):
    """What a moving body keeps clear of; metres, map.

    Attributes:
        points: (N, 2) where beams ended, or centres of obstacle cells.
        half_cell: radius of each point: half the edge of a cell, or of a sub-cell.
        unseen: centres (M, 2) of cells near the body that neither map nor costmap has
            seen.
    """

    points: NDArray[np.float64]
    half_cell: float
    unseen: NDArray[np.float64]


class ObstacleTracker:
    """Places the newest costmap in the map once the pose at its stamp is available.

    Args:
        poses: poses of the robot.
        footprint: outline of the body.
        hand_m: width of the space around the body, where the robot was put down, that
            counts as free.
    """

    def __init__(self, poses: RobotPoses, footprint: Footprint, hand_m: float) -> None:
        self._poses = poses
        self._zones: tuple[NDArray[np.int8], GridSpec] | None = None
        self.configure(footprint, hand_m)
        self._base_T_costmap: tuple[str, Pose2] | None = None  # with its frame
        self.reset()

    def configure(self, footprint: Footprint, hand_m: float) -> None:
        """Replace the outline and the width."""
        self._start = StartArea.of(footprint, Pose2(0.0, 0.0, 0.0), hand_m)
        self._body_m = footprint.circumscribed_radius

    def reset(self) -> None:
        """Forget all costmaps and the map."""
        self._map = MapObstacles()
        self._newest: Layer | None = None  # the map
        # What any map has shown, in these cells of the newest.
        self._seen: Layer | None = None
        self._seen_window = NO_CELLS
        self._hits = HitPoints()
        self._costmap: OccupancyGrid | None = None  # newest, not placed yet
        self._placed: OccupancyGrid | None = None  # newest that was placed
        self._costmap_ns: int | None = None
        #: Arrival of the costmap that was placed last; None before the first.
        self.placed_ns: int | None = None

    def receive(self, msg: OccupancyGrid, now_ns: int) -> None:
        """Store a costmap until it is placed."""
        self._costmap, self._costmap_ns = msg, now_ns

    def remember(
        self,
        known: ReceivedMap,
        part: MapPart | None,
        stamp_ns: int,
        now_ns: int,
        lethal_cost: int,
    ) -> None:
        """Use a map, in the map frame, for what the costmap does not show.

        What earlier maps have shown is kept near the robot only.

        Args:
            known: the map.
            part: changes the map first; None: the whole map is new.
            stamp_ns: stamp of the map.
            now_ns: time of the node's clock.
            lethal_cost: value from which a cell is an obstacle.
        """
        near = self._near_robot(known.spec, now_ns)
        before = self._seen
        is_shared = before is not None and before.cells is known.cells
        if is_shared and part is not None and _loses(part, known.cells, near):
            known.share()  # free space that the map loses has been seen nevertheless
        known.update(part)
        self._map.receive(known.cells, known.spec, stamp_ns)
        self._newest = Layer(known.cells, known.spec)
        self._seen = _seen_also(self._newest, before, near, lethal_cost)
        is_whole = self._seen is self._newest
        self._seen_window = CellWindow.whole(known.spec.shape) if is_whole else near

    def _near_robot(self, spec: GridSpec, now_ns: int) -> CellWindow:
        """Return the cells near the robot; all while its pose is not known."""
        robot = self._poses.predicted_now(now_ns)
        if robot is None:
            return CellWindow.whole(spec.shape)
        return _cells_around(robot, _NEAR_M, spec)

    def relocate(self) -> None:
        """Place the newest costmap again: the robot's pose in the map has jumped.

        What maps have shown near the robot was somewhere else.
        """
        self._costmap = self._costmap or self._placed
        self._seen = None

    def keep_out(self, cells: NDArray[np.int8], spec: GridSpec) -> None:
        """Use zones (H, W), map frame, 100 = keep out, as obstacles in any case."""
        self._zones = cells, spec

    def receive_points(self, msg: PointCloud2) -> None:
        """Use the points for the costmap with the same stamp.

        Raises:
            InvalidValueError: the cloud is invalid.
        """
        self._hits.receive(msg)

    def remember_points(self, msg: PointCloud2) -> None:
        """Use the points for the map with the same stamp.

        Raises:
            InvalidValueError: the cloud is invalid.
        """
        self._map.receive_points(msg)

    def place(
        self, now_ns: int, lethal_cost: int, reach_m: float, unseen_reach_m: float
    ) -> Obstacles | None:
        """Return the obstacles within reach of the robot; None if nothing has changed.

        Args:
            now_ns: time of the node's clock.
            lethal_cost: value from which a cell is an obstacle.
            reach_m: radius of the region of the obstacles.
            unseen_reach_m: radius of the region in which unseen space matters.

        Raises:
            InvalidValueError: the costmap is invalid; it is dropped.
        """
        msg = self._costmap
        if msg is None:
            return None
        map_T_frame = self._placement(msg)
        around = self._poses.predicted_now(now_ns)
        if map_T_frame is None or around is None:
            return None
        self._costmap, self._placed = None, msg
        cells, spec = grid_from_message(msg)
        here = Layer(cells, placed(spec, map_T_frame))
        nearby = partial(
            obstacle_points, lethal_cost=lethal_cost, around=around, reach_m=reach_m
        )
        hits = self._hits.at(stamp_of(msg.header))
        if hits is None:
            points = nearby(cells, spec, map_T_frame)
            radius = max(spec.resolution / 2, self._map.half_cell_m)
            region = Region(around, reach_m, lethal_cost, None)
        else:
            points = points_within(hits, map_T_frame, around=around, reach_m=reach_m)
            radius = point_radius(spec.resolution)
            region = Region(around, reach_m, lethal_cost, radius)
        known = self._map.hidden_from(here, region, self._body_m)
        points = np.concatenate([points, known])
        if self._zones is not None:
            forbidden = nearby(*self._zones, Pose2(0.0, 0.0, 0.0))
            points = np.concatenate([points, forbidden])
        self.placed_ns = self._costmap_ns
        return Obstacles(points, radius, self._unseen(here, around, unseen_reach_m))

    def _unseen(
        self, here: Layer, around: Pose2, reach_m: float
    ) -> NDArray[np.float64]:
        """Return the cells near the body that neither a map nor the costmap has seen.

        Free space that a request has cleared from the map has been seen nevertheless.
        """
        seen = self._seen_around(around, min(reach_m, FARTHEST_M))
        layers = (here,) if seen is None else (seen, here)
        first = self._poses.first
        assert first is not None, "the pose is known"
        start = self._start._replace(map_T_base=first)
        return unseen_points(layers, start, around, reach_m)

    def _seen_around(self, around: Pose2, reach_m: float) -> Layer | None:
        """Return what any map has shown, or only the newest one.

        The latter if the robot has left the cells that it was near at that map.
        """
        if self._seen is None or self._newest is None or self._seen is self._newest:
            return self._seen
        needed = _cells_around(around, reach_m, self._newest.spec)
        return self._seen if self._seen_window.contains(needed) else self._newest

    def _placement(self, msg: OccupancyGrid) -> Pose2 | None:
        """Return map_T_frame of the costmap at its stamp."""
        frame = msg.header.frame_id
        if frame == self._poses.map_frame:
            return Pose2(0.0, 0.0, 0.0)
        if self._base_T_costmap is None or self._base_T_costmap[0] != frame:
            base_T_frame = self._poses.transform_to_base(frame)
            if base_T_frame is None:
                return None
            self._base_T_costmap = (frame, base_T_frame)
        map_T_base = self._poses.predicted_at(stamp_of(msg.header))
        return None if map_T_base is None else map_T_base @ self._base_T_costmap[1]


def _loses(part: MapPart, cells: Cells, near: CellWindow) -> bool:
    """Return whether known cells of a map would be overwritten with unknown ones."""
    if part.whole is not None:
        return False  # another array
    down, right = -part.window.first_row, -part.window.first_column
    here = near.shifted(down, right).grown(0, part.cells.shape)
    lost: bool = _has_lost(part.cells, cells, here, down, right)
    return lost


def _cells_around(pose: Pose2, reach_m: float, spec: GridSpec) -> CellWindow:
    row, column = spec.cell_of(pose.x, pose.y)
    here = CellWindow(row, row + 1, column, column + 1)
    return here.grown(math.ceil(reach_m / spec.resolution), spec.shape)


def _seen_also(
    now: Layer, before: Layer | None, near: CellWindow, lethal_cost: int
) -> Layer:
    """Return a layer whose cells in a window are known where they are in one of two.

    Obstacles that only the layer before shows are unknown: they may still stand where
    no sensor looks. The layer of now if it shows all cells, otherwise one of the window
    only. An empty window: the robot is far outside of the map.
    """
    if before is None or near.is_empty:
        return now
    shift = _shift_of_cells(now.spec, before.spec)
    if shift is not None and not _has_lost(now.cells, before.cells, near, *shift):
        return now
    here = now.cells[near.slices]
    seen = Layer(here.copy(), near.spec_in(now.spec))
    merge(*seen, *before, "max")
    seen.cells[(here == UNKNOWN) & (seen.cells >= lethal_cost)] = UNKNOWN
    return seen


def _shift_of_cells(spec: GridSpec, other: GridSpec) -> tuple[int, int] | None:
    """Return row and column in a grid of the first cell of another; None: between."""
    if spec.resolution != other.resolution or spec.origin.yaw != other.origin.yaw:
        return None
    corner = spec.origin.inverse() @ other.origin
    u, v = corner.x / spec.resolution, corner.y / spec.resolution
    row, column = round(v), round(u)
    return (row, column) if math.hypot(v - row, u - column) < _SAME_CELLS else None


@kernel(allocates=False)
def _has_lost(now: Any, before: Any, near: Any, down: int, right: int) -> bool:
    """Return whether a cell in a window is unknown now and was known before.

    ``down``, ``right``: row and column now of the first cell before.
    """
    first_row = max(near.first_row, down)
    first = max(near.first_column, right)
    last = max(first, min(near.last_column, right + before.shape[1]))
    for row in range(first_row, min(near.last_row, down + before.shape[0])):
        new, old = (
            now[row, first:last],
            before[row - down, first - right : last - right],
        )
        lost = False
        for k in range(new.size):
            lost |= (new[k] == UNKNOWN) & (old[k] != UNKNOWN)
        if lost:
            return True
    return False
