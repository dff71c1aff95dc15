"""Base class of the nodes that command motion: robot and obstacles on the map."""

from collections.abc import Callable
from typing import Any, ClassVar

from navette.errors import InvalidInputError, InvalidValueError
from navette.geometry import Footprint
from navette.msgs import topics
from navette.msgs.map_msgs.msg import OccupancyGridUpdate
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.sensor_msgs.msg import PointCloud2
from navette.navigation.grids import (
    MapPart,
    Obstacles,
    ObstacleTracker,
    grid_from_message,
    load_obstacle_kernels,
)
from navette.navigation.grids.checks import check_frame
from navette.navigation.servers.map_reader_node import (
    MAP_UPDATES_INPUT,
    MapReaderNode,
)
from navette.navigation.shared_params import MotionParams
from navette.runtime import MessageInfo
from navette.runtime.stage.input_period import InputPeriod
from navette.runtime.stage.odometry import PoseTracker
from navette.runtime.stage.stage_node import Input


class MotionNode(MapReaderNode):
    """Node that locates the robot and keeps the obstacles around it.

    A derived class subscribes to MOTION_INPUTS and implements ``on_odometry``.
    """

    MOTION_INPUTS: ClassVar[tuple[Input, ...]] = (
        Input.of(
            topics.ODOMETRY,
            "pose and velocity",
            rate_hz=10.0,
            timeout_s=0.14,
            callback="on_odometry",
        ),
        Input.of(
            topics.COSTMAP_POINTS,
            "where the beams of the costmap with the same stamp ended",
            callback="on_costmap_points",
        ),
        Input.of(
            topics.COSTMAP,
            "obstacles to keep clear of",
            rate_hz=10.0,
            timeout_s=0.19,
            callback="on_costmap",
        ),
        Input.of(
            topics.MAP_POINTS,
            "where beams ended, within the lethal cells of the map with the same stamp",
            callback="on_map_points",
        ),
        Input.of(
            topics.MAP,
            "obstacles that the costmap does not show, such as behind the robot",
            callback="on_map",
        ),
        MAP_UPDATES_INPUT,
        Input.of(
            topics.KEEPOUT_ZONES,
            "zones that the robot must not touch",
            callback="on_keepout_zones",
        ),
    )

    params: MotionParams

    def __init__(self, node_name: str, **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._odometry_period, self._costmap_period = InputPeriod(), InputPeriod()
        self._start_tracking()
        load_obstacle_kernels(Footprint.from_flat(self.params.footprint_m))

    def on_costmap_points(self, msg: PointCloud2) -> None:
        """Store where the beams of a costmap ended."""
        self._use_points(self._obstacles.receive_points, msg)

    def on_map_points(self, msg: PointCloud2) -> None:
        """Store where beams ended, for the map."""
        self._use_points(self._obstacles.remember_points, msg)

    def on_costmap(self, msg: OccupancyGrid) -> None:
        """Store the newest costmap until the pose at its stamp is available."""
        self._costmap_period.note(self._now_ns)
        self._obstacles.receive(msg, self._now_ns)

    def on_map_update(self, msg: OccupancyGridUpdate, info: MessageInfo) -> None:
        """Store the newest update until the obstacles are placed.

        The whole map of its stamp may arrive first, and is used without a copy.
        """
        self._apply_updates()
        self._receive_update(msg, info)

    def on_new_map(self, part: MapPart | None) -> None:
        """Use the map for what the costmap does not show."""
        maps = self._maps
        assert maps.map is not None, "a map has arrived"
        self._obstacles.remember(
            maps.map, part, maps.stamp_ns, self._now_ns, self.params.lethal_cost
        )

    def on_keepout_zones(self, msg: OccupancyGrid) -> None:
        """Keep clear of zones as of obstacles."""
        check_frame("keep-out zones", msg.header.frame_id, self.params.map_frame)
        try:
            self._obstacles.keep_out(*grid_from_message(msg))
        except InvalidValueError as error:
            raise InvalidInputError("out_of_range", str(error)) from None

    @property
    def _now_ns(self) -> int:
        return self._clock.now_ns

    @property
    def _odometry_timeout_s(self) -> float:
        """Age at which odometry is stale, from its measured period."""
        params = self.params
        return self._odometry_period.timeout_s(
            params.odometry_timeout_s, params.stale_periods
        )

    @property
    def _costmap_timeout_s(self) -> float:
        """Age at which the costmap is stale, from its measured period."""
        params = self.params
        return self._costmap_period.timeout_s(
            params.costmap_timeout_s, params.stale_periods
        )

    def _start_tracking(self) -> None:
        """Forget the poses, the map and the obstacles."""
        params = self.params
        self._maps.forget()
        self._tracker = PoseTracker(self, params.base_frame, params.map_frame)
        footprint = Footprint.from_flat(params.footprint_m)
        self._obstacles = ObstacleTracker(
            self._tracker, footprint, params.blind_reverse_m
        )

    def _use_points(self, use: Callable[[PointCloud2], None], msg: PointCloud2) -> None:
        try:
            use(msg)
        except InvalidValueError as error:
            raise InvalidInputError("out_of_range", str(error)) from None

    def _placed_obstacles(
        self, reach_m: float, unseen_reach_m: float
    ) -> Obstacles | None:
        """Return the obstacles of a costmap that is newly placed; None: no change."""
        try:
            self._apply_updates()
        except InvalidInputError as error:
            self.drop_input(topics.MAP_UPDATES.name, error)
        try:
            return self._obstacles.place(
                self._now_ns, self.params.lethal_cost, reach_m, unseen_reach_m
            )
        except InvalidValueError as error:
            # The last valid costmap ages until the robot stops.
            invalid = InvalidInputError("out_of_range", str(error))
            self.drop_input(topics.COSTMAP.name, invalid)
            return None
