"""The map memory node: costmaps and odometry in, map out.

The node publishes an unknown map at the start, latched, then one after each fused
costmap. Costmaps are placed with the pose interpolated at their stamp; without odometry
or transforms they are dropped and the map does not change.
"""

import dataclasses
import math
import pathlib
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.errors import FileFormatError, InvalidInputError, InvalidValueError
from navette.geometry import Footprint, Pose2
from navette.geometry.map_files import read_occupancy_map
from navette.msgs import topics
from navette.msgs.geometry_msgs.msg import Quaternion
from navette.msgs.nav2_dynamic_msgs.msg import ObstacleArray
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry, Path
from navette.msgs.sensor_msgs.msg import PointCloud2
from navette.navigation.grids import (
    NO_CELLS,
    NO_DISCS,
    CellWindow,
    GridSpec,
    HitPoints,
    MovingDiscs,
    SquareRegion,
    discs_from_message,
    grid_from_message,
    grid_to_message,
    inside_discs,
    placed,
    points_to_message,
    window_to_message,
    without_discs,
)
from navette.navigation.grids.spec import Cells
from navette.navigation.mapping.gate import FusionGate
from navette.navigation.mapping.keyframes import Keyframes, replaced
from navette.navigation.mapping.memory import (
    STEADY,
    BodyMotion,
    MapMemory,
    PlacedCostmap,
)
from navette.navigation.mapping.params import MapMemoryParams
from navette.navigation.mapping.placement import PlacementQueue, Ready
from navette.navigation.mapping.rebuilding import RebuildingMemory
from navette.navigation.mapping.servers.map_services import MapServices
from navette.navigation.mapping.whole_maps import WholeMaps
from navette.navigation.servers.costmap_services import CostmapServices
from navette.navigation.servers.lifecycle import StageLifecycle
from navette.runtime import Input, Output, StageNode, stamp_to_ns
from navette.runtime.stage.odometry import PoseTracker
from navette.runtime.stage.path_messages import pose_of

# A stamp this much older than the last fused one belongs to a new run: the simulation
# was reset, or a bag starts again.
NEW_RUN_NS = 1_000_000_000
# Age of the moving obstacles from which they are obsolete, and what is added to their
# radius: errors of tracking and cells that are partly covered.
_MOVING_TIMEOUT_S = 0.5
_MOVING_MARGIN_M = 0.25


class _Arrival(NamedTuple):
    """A placed costmap without its hits, and what they are placed with."""

    costmap: PlacedCostmap
    map_T_sensor: Pose2
    moving: NDArray[np.float64]
    """(M, 5), of :class:`~navette.navigation.grids.MovingDiscs`, at the same stamp"""


class MapMemoryNode(StageNode):
    """Fuse costmaps into a map and publish it."""

    PARAMS = MapMemoryParams
    INPUTS: ClassVar = (
        Input.of(
            topics.COSTMAP,
            "costs around the sensor",
            rate_hz=10.0,
            timeout_s=0.5,
            callback="on_costmap",
        ),
        Input.of(
            topics.COSTMAP_POINTS,
            "where the beams of the costmap with the same stamp ended",
            callback="on_costmap_points",
        ),
        Input.of(
            topics.ODOMETRY,
            "pose and velocity",
            rate_hz=10.0,
            timeout_s=0.5,
            callback="on_odometry",
        ),
        Input.of(
            topics.TRACKED_OBSTACLES,
            "moving obstacles, which leave no trail in the map",
            callback="on_moving",
        ),
        Input.of(
            topics.TRAJECTORY,
            "where the robot has been according to SLAM; the map is corrected with it",
            callback="on_trajectory",
        ),
    )
    OUTPUTS: ClassVar = (
        Output.of(
            topics.MAP_POINTS,
            "where beams ended, within the lethal cells of the map with the same stamp",
        ),
        Output.of(
            topics.MAP,
            "map of everything seen so far",
        ),
        Output.of(
            topics.STATIC_MAP,
            "the loaded map, as it is; only if one is loaded",
        ),
        Output.of(
            topics.MAP_UPDATES,
            "the part of the map that changed; without cells if /map replaces it",
        ),
        Output.of(
            topics.GLOBAL_COSTMAP,
            "the map, under Nav2's name, once somebody has subscribed to it",
        ),
        Output.of(
            topics.GLOBAL_COSTMAP_UPDATES,
            "the part of it that changed, under Nav2's name",
        ),
    )

    params: MapMemoryParams
    _odometry: Odometry | None  # newest

    def __init__(self, node_name: str = "map_memory", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._has_nav2_reader = False
        self._is_starting = True
        self._whole_maps = WholeMaps()
        self._map_ns = -1  # stamp of the newest map
        self._is_outside = False  # the robot at the newest costmap
        self._tracker = self._new_tracker()
        trajectory = self.resolve_topic_name(topics.TRAJECTORY.name)
        self._trajectories = next(
            each for each in self.subscriptions if each.topic_name == trajectory
        )
        self._start()
        self._memory.warm_up()
        self._timer = self.create_timer(self.params.update_period_s, self.on_timer)
        self._lifecycle = StageLifecycle(self, "map_server")
        self._map_services = MapServices(self, store=self)
        self._costmap_services = CostmapServices(self, "global_costmap", source=self)
        if self.params.map_file:
            self._load_file()
        # Who has subscribed so far depends on chance, and a lock-step is repeatable.
        self._served, self._is_starting = 0, False

    def on_odometry(self, msg: Odometry) -> None:
        """Update the robot's pose; place the costmaps that waited for it."""
        jumps = self._tracker.jumps
        self._tracker.update(msg)
        if self._tracker.jumps != jumps:
            self._relocate()
        self._odometry = msg
        if self._waiting:
            self._place_waiting()

    def on_costmap_points(self, msg: PointCloud2) -> None:
        """Store where beams ended for the costmap of the same stamp."""
        try:
            self._hits.receive(msg)
        except InvalidValueError as error:
            raise InvalidInputError("out_of_range", str(error)) from None

    def on_costmap(self, msg: OccupancyGrid) -> None:
        """Place the costmap as soon as its pose is available."""
        stamp_ns = stamp_to_ns(msg.header.stamp)
        if stamp_ns < self._last_stamp_ns - NEW_RUN_NS:
            self.get_logger().info(
                "time went back: the map is reset", throttle_duration_sec=5.0
            )
            self._restart()
        self._waiting.add(msg, stamp_ns, self._now_ns())
        self._place_waiting()

    def on_moving(self, msg: ObstacleArray) -> None:
        """Store the moving obstacles."""
        self._moving = discs_from_message(msg, self.params.map_frame)

    def on_trajectory(self, msg: Path) -> None:
        """Rebuild the map from the costmaps at their corrected poses."""
        if msg.header.frame_id != self.params.map_frame:
            raise InvalidInputError(
                "unknown_frame",
                f"trajectory in frame {msg.header.frame_id!r}; expected map_frame, "
                f"{self.params.map_frame!r}",
            )
        trajectory = [
            (stamp_to_ns(each.header.stamp), pose_of(each.pose)) for each in msg.poses
        ]
        corrected = self._keyframes.correct(trajectory)
        if corrected:
            self._rebuilding.rebuild(corrected)

    def on_timer(self) -> None:
        """Fuse the newest costmap if the robot moved far enough."""
        newest = self._newest
        if newest and self._gate.on_timer(newest.costmap, self._memory):
            self._fuse(newest)
        elif self._whole_ns < self._map_ns and self._subscribers() > self._served:
            self._publish_whole()  # to subscribers that came since
        elif not self._has_nav2_reader and self._find_nav2_reader():
            self.hand_over(topics.GLOBAL_COSTMAP.name, self.newest_grid())

    def on_params_changed(self, old: MapMemoryParams) -> None:
        """Reset the map if its shape changed; other values apply at once."""
        if self.params.map_file and self.params.map_file != old.map_file:
            try:
                self._load_file()
            except FileFormatError as error:
                self.get_logger().error(f"map not loaded: {error}")
        if self.params.update_period_s != old.update_period_s:
            self.destroy_timer(self._timer)
            self._timer = self.create_timer(self.params.update_period_s, self.on_timer)
        if self.params.shape() != old.shape():
            if self.params.frames() != old.frames():
                self._tracker = self._new_tracker()
            self._rebuilding.drop()
            self._start()
        else:
            params = self.params
            self._rebuilding.change(lambda memory: memory.configure(params))
            self._gate.params = params

    def on_time_jump(self) -> None:
        """Reset the map."""
        self._tracker.reset()
        self._map_ns = -1
        self._restart()

    def _new_tracker(self) -> PoseTracker:
        return PoseTracker(self, self.params.base_frame, self.params.map_frame)

    def _start(self) -> None:
        self._rebuilding = RebuildingMemory(
            MapMemory(self.params), self.worker, on_rebuilt=self._on_rebuilt
        )
        self._gate = FusionGate(self.params)
        self._restart()

    @property
    def _memory(self) -> MapMemory:
        return self._rebuilding.memory

    def _restart(self) -> None:
        self._odometry = None
        self._moving = MovingDiscs(NO_DISCS, 0)
        self._rebuilding.drop()
        self._memory.reset()
        self._gate.reset()
        self._waiting = PlacementQueue[OccupancyGrid](
            round(self.params.pose_wait_s * 1e9)
        )
        self._hits = HitPoints()
        self._newest: _Arrival | None = None
        self._keyframes = Keyframes()
        self._last_stamp_ns = 0
        self._published: OccupancyGrid | None = None  # None: not built yet
        self._whole_ns = self._served = 0
        self._publish_map(self._now_ns())

    def _relocate(self) -> None:
        """Correct the map after a jump of the pose.

        With a trajectory, :meth:`on_trajectory` does that. Otherwise what was fused may
        be at wrong places: the loaded map remains.
        """
        if self._is_corrected:
            return
        newest, self._newest = self._newest, None
        pose = newest and self._tracker.pose_at(newest.costmap.stamp_ns)
        if newest is None or pose is None:
            self._rebuilding.rebuild([])
            return
        before = newest.costmap.map_T_base
        self._newest = newest._replace(
            costmap=replaced(newest.costmap, pose),
            map_T_sensor=pose @ before.inverse() @ newest.map_T_sensor,
        )
        self._rebuilding.rebuild([replaced(self._with_hits(newest), pose)])

    @property
    def _is_corrected(self) -> bool:
        """Whether a trajectory is published, so that costmaps are kept for it."""
        return self._trajectories.get_publisher_count() > 0

    def _on_rebuilt(self) -> None:
        self._gate.reset()
        self._publish_map(self._now_ns())

    def _place_waiting(self) -> None:
        ready, dropped = self._waiting.take(self._tracker, self._now_ns())
        for lost in dropped:
            if self._last_stamp_ns == 0:
                continue  # before the first pose: the localization is starting
            at = f"stamp {lost.stamp_ns / 1e9:.3f} s"
            self._drop("no_pose", f"{lost.reason} ({at})")
        for each in ready:
            arrival = self._placed(each)
            if arrival is not None:
                self._on_placed(arrival)

    def _placed(self, ready: Ready[OccupancyGrid]) -> _Arrival | None:
        frame_id = ready.item.header.frame_id
        base_T_sensor = self._tracker.transform_to_base(frame_id)
        if base_T_sensor is None:
            return None  # counted by the tracker
        map_T_sensor = ready.map_T_base @ base_T_sensor
        try:
            cells, spec = grid_from_message(ready.item)
            there = placed(spec, map_T_sensor)
        except InvalidValueError as error:
            self._drop("out_of_range", str(error))
            return None
        moving = self._moving.at(ready.stamp_ns, _MOVING_TIMEOUT_S)
        costmap = PlacedCostmap(
            without_discs(cells, there, moving, _MOVING_MARGIN_M),
            there,
            (map_T_sensor.x, map_T_sensor.y),
            ready.map_T_base,
            ready.stamp_ns,
            self._motion(),
        )
        return _Arrival(costmap, map_T_sensor, moving)

    def _motion(self) -> BodyMotion:
        if self._odometry is None:
            return STEADY
        twist, pose = self._odometry.twist.twist, self._odometry.pose.pose
        return BodyMotion(twist.angular.z, twist.linear.z, _tilt_of(pose.orientation))

    def _on_placed(self, arrival: _Arrival) -> None:
        self._newest, costmap = arrival, arrival.costmap
        if self._is_corrected:
            odom_T_base = self._tracker.in_odom(costmap.map_T_base)
            self._keyframes.trace(costmap.stamp_ns, odom_T_base)
        if self._gate.on_arrival(costmap, self._memory, self._now_ns()):
            self._fuse(arrival)

    def _fuse(self, arrival: _Arrival) -> None:
        costmap = self._with_hits(arrival)
        if not self._rebuilding.change(lambda memory: memory.fuse(costmap)):
            return
        self._gate.fused(arrival.costmap, self._now_ns())
        self._check_extent(costmap.map_T_base)
        if self._is_corrected:
            odom_T_base = self._tracker.in_odom(costmap.map_T_base)
            self._keyframes.add(costmap, odom_T_base)
        self._last_stamp_ns = costmap.stamp_ns
        self._publish_map(costmap.stamp_ns)

    def _check_extent(self, robot: Pose2) -> None:
        """Warn when the robot leaves the largest map: nothing is remembered there."""
        spec, was_outside = self._memory.spec, self._is_outside
        self._is_outside = not spec.contains(*spec.cell_of(robot.x, robot.y))
        if self._is_outside and not was_outside:
            self.get_logger().warning(
                f"the robot at ({robot.x:.1f}, {robot.y:.1f}) is outside of the map, "
                f"which cannot grow to there from {spec.width} x {spec.height} cells "
                f"of {spec.resolution} m: max_size_m is {self.params.max_size_m} m at "
                f"resolution_m {self.params.resolution_m} m"
            )

    def _with_hits(self, arrival: _Arrival) -> PlacedCostmap:
        """Return the costmap with the points of its stamp: most are not fused."""
        hits = self._hits.at(arrival.costmap.stamp_ns)
        if hits is None:
            return arrival.costmap
        points = arrival.map_T_sensor.apply(hits)
        if len(arrival.moving):
            points = points[~inside_discs(points, arrival.moving, _MOVING_MARGIN_M)]
        return dataclasses.replace(arrival.costmap, hits=points)

    def _publish_map(self, stamp_ns: int) -> None:
        if 0 <= self._map_ns - stamp_ns < NEW_RUN_NS:
            # A costmap that is fused again after a request: stamps identify the maps.
            stamp_ns = self._map_ns + 1
        memory, frame_id = self._memory, self.params.map_frame
        points = points_to_message(memory.hit_points(), frame_id, stamp_ns)
        self.hand_over(topics.MAP_POINTS.name, points)
        window = memory.take_change()
        self._whole_maps.note_change(window)
        if window is None or stamp_ns < self._map_ns:
            window = NO_CELLS
        self._map_ns, self._published = stamp_ns, None
        self._publish_update(window)
        is_served = not window.is_empty and self._subscribers() <= self._served
        if self.params.always_send_full_map or not is_served:
            self._publish_whole()

    def _publish_update(self, window: CellWindow) -> None:
        """Publish the changed part before the whole map of the same stamp.

        No cells: the whole map replaces the one before. Each map has an update, so that
        readers notice by its number if one is missing.
        """
        cells, frame_id = self._memory.cells, self.params.map_frame
        update = window_to_message(cells, window, frame_id, self._map_ns)
        self.hand_over(topics.MAP_UPDATES.name, update)
        if self.has_listeners(topics.GLOBAL_COSTMAP_UPDATES.name):
            self.hand_over(topics.GLOBAL_COSTMAP_UPDATES.name, update)

    def _publish_whole(self) -> None:
        self._served, self._whole_ns = self._subscribers(), self._map_ns
        message = self.newest_grid()
        self.hand_over(topics.MAP.name, message)
        if self._find_nav2_reader():
            self.hand_over(topics.GLOBAL_COSTMAP.name, message)

    def _find_nav2_reader(self) -> bool:
        """Return whether somebody has subscribed to the map under Nav2's name so far.

        Until then the network need not keep a second copy of the map. From then on
        each map is published, so that a late subscriber gets the newest.
        """
        if not self._has_nav2_reader and not self._is_starting:
            self._has_nav2_reader = self.has_listeners(topics.GLOBAL_COSTMAP.name)
        return self._has_nav2_reader

    # -- MapStore and CostmapSource ----------------------------------------------

    @property
    def footprint(self) -> Footprint | None:
        return self._memory.footprint

    @property
    def is_probability_map(self) -> bool:
        return self.params.fusion == "log_odds"

    def map_topics(self) -> tuple[str, ...]:
        names = topics.MAP.name, topics.GLOBAL_COSTMAP.name
        return tuple(map(self.resolve_topic_name, names))

    def robot_on_grid(self) -> Pose2 | None:
        return self._tracker.frame_on_map(self.params.base_frame)

    def frame_on_grid(self, frame_id: str) -> Pose2 | None:
        return self._tracker.frame_on_map(frame_id)

    def newest_grid(self) -> OccupancyGrid:
        """Return the map as it was last published, or updated."""
        if self._published is None:
            memory, frame_id = self._memory, self.params.map_frame
            self._published = self._whole_maps.message(
                memory.cells, memory.spec, frame_id, self._map_ns
            )
        return self._published

    def _subscribers(self) -> int:
        """Return the number of subscriptions to the whole map."""
        publishers = self.publishers_by_topic
        return sum(
            publishers[each.name].get_subscription_count()
            for each in (topics.MAP, topics.GLOBAL_COSTMAP)
        )

    def load_map(self, cells: Cells, spec: GridSpec) -> None:
        """Replace the map by a loaded one; scans change it from now on."""
        frame_id, now_ns = self.params.map_frame, self._now_ns()
        known = grid_to_message(cells, spec, frame_id, now_ns)
        self._rebuilding.drop()
        shared, _ = grid_from_message(known)  # no copy, but a rounded geometry
        self._memory.load(shared, spec)
        self._gate.reset()
        self.hand_over(topics.STATIC_MAP.name, known)
        self._publish_map(self._now_ns())

    def _load_file(self) -> None:
        known = read_occupancy_map(pathlib.Path(self.params.map_file).expanduser())
        height, width = known.cells.shape
        spec = GridSpec(known.resolution, width, height, known.origin)
        self.load_map(known.cells, spec)

    def clear_costmap(self, region: SquareRegion | None) -> None:
        """Clear a region of the map; what is seen now is fused again at once.

        What stands beside the body where no sensor looks stays: a robot that turns
        there would touch it.
        """
        newest = self._newest

        def clear(memory: MapMemory) -> bool:
            if newest is None:
                memory.clear(region)
                return False
            beside = memory.points_in_blind_spot(newest.costmap)
            memory.clear(region)
            is_fused = memory.fuse(self._with_hits(newest))
            memory.restore(beside)
            return is_fused

        if self._rebuilding.change(clear) and newest is not None:
            self._gate.fused(newest.costmap, self._now_ns())
        self._publish_map(self._now_ns())

    def _drop(self, reason: str, detail: str) -> None:
        self.drop_input(topics.COSTMAP.name, InvalidInputError(reason, detail))

    def _now_ns(self) -> int:
        return self.get_clock().now_ns


def _tilt_of(q: Quaternion) -> float:
    """Return the angle between the body's z axis and the vertical, rad."""
    upright = 1.0 - 2.0 * (q.x * q.x + q.y * q.y)
    return math.acos(min(1.0, max(-1.0, upright)))
