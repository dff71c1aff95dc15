"""The costmap node: scan in, costmap out.

Before the first scan the node publishes nothing, then one costmap for each scan, at
most ``rate_hz`` a second, in the scan's frame and with its stamp. An invalid scan is
dropped, so that the costmap becomes stale downstream.
"""

from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from navette.geometry import Footprint, Pose2
from navette.msgs import topics
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.navigation.costmap.layers import (
    ObstacleLayerParams,
    RangeLayerParams,
    SourceParams,
)
from navette.navigation.costmap.own_costmap import make_costmap
from navette.navigation.costmap.params import CostmapParams
from navette.navigation.costmap.servers.obstacle_sources import (
    ObstacleSources,
    declare_layer,
)
from navette.navigation.grids import (
    FREE,
    PlanarScan,
    SquareRegion,
    grid_from_message,
    grid_to_message,
    points_to_message,
)
from navette.navigation.servers.costmap_services import CostmapServices
from navette.params.plugins import MethodFaultError
from navette.runtime import Input, Output, StageNode, stamp_to_ns


class CostmapNode(StageNode):
    """Convert each scan to a costmap around the sensor."""

    PARAMS = CostmapParams
    PARAM_GROUPS: ClassVar = {
        "obstacle_layer.": ObstacleLayerParams,
        "obstacle_layer.SOURCE.": SourceParams,
        "range_layer.": RangeLayerParams,
    }
    INPUTS: ClassVar = (
        Input.of(
            topics.LIDAR,
            "laser scan",
            rate_hz=10.0,
            timeout_s=0.5,
            callback="on_scan",
        ),
    )
    OUTPUTS: ClassVar = (
        Output.of(
            topics.COSTMAP_POINTS,
            "where the beams ended, more exact than the costmap's cells",
            rate_hz=10.0,
        ),
        Output.of(
            topics.COSTMAP,
            "costs around the sensor",
            rate_hz=10.0,
        ),
        Output.of(
            topics.LOCAL_COSTMAP,
            "the same under Nav2's name, only while it is subscribed to",
            rate_hz=10.0,
        ),
    )

    params: CostmapParams

    def __init__(self, node_name: str = "costmap", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._sources: ObstacleSources | None = None
        if self._layer_settings.sources:
            self._sources = ObstacleSources(self, self._layer_settings, self.params)
        self._costmap = make_costmap(self.params)
        self._costmap.warm_up()
        self._fault = ""  # newest of the user's method, or of a source
        self._newest: OccupancyGrid | None = None
        self._services = CostmapServices(self, "local_costmap", source=self)

    def declare_params(self) -> Any:
        """Declare the parameters of the obstacle layer, too."""
        self._layer_settings = declare_layer(self)
        return super().declare_params()

    def inputs(self) -> tuple[Input, ...]:
        scans = replace(self.INPUTS[0], most_hz=self.params.rate_hz)
        if not self._layer_settings.sources:
            return (scans,)
        settings = self._layer_settings
        return (scans, *ObstacleSources.inputs(settings, self._obstacle_sources))

    def _obstacle_sources(self) -> ObstacleSources:
        assert self._sources is not None, "created before the node spins"
        return self._sources

    def on_time_jump(self) -> None:
        """Forget what other sensors observed: a new run."""
        if self._sources is not None:
            self._sources.reset()

    def on_scan(self, msg: LaserScan) -> None:
        """Publish the costmap of a scan."""
        stamp_ns = stamp_to_ns(msg.header.stamp)
        scan = PlanarScan(
            np.asarray(msg.ranges),
            msg.angle_min,
            msg.angle_increment,
            msg.range_min,
            msg.range_max,
        )
        frame_id = msg.header.frame_id
        obstacles = None
        if self._sources is not None:
            stale = self._sources.stale()
            if stale:
                self._report_fault(stale)
                return
            obstacles = self._sources.obstacles_in(frame_id, stamp_ns)
            if obstacles is None:
                return
        try:
            cells = self._costmap.build(scan, obstacles)
        except MethodFaultError as error:
            self._report_fault(str(error))
            return
        self._fault = ""
        hits = self._costmap.hits(scan)
        if hits is not None and obstacles is not None:
            hits = np.concatenate([hits, obstacles])
        if hits is not None:
            points = points_to_message(hits, frame_id, stamp_ns)
            self.hand_over(topics.COSTMAP_POINTS.name, points)
        message = grid_to_message(cells, self._costmap.spec, frame_id, stamp_ns)
        self._newest = message
        self.hand_over(topics.COSTMAP.name, message)
        if self.has_listeners(topics.LOCAL_COSTMAP.name):
            self.hand_over(topics.LOCAL_COSTMAP.name, message)

    def _report_fault(self, fault: str) -> None:
        """Log a fault of method or source once; without a costmap the robot stops."""
        if fault != self._fault:
            self._fault = fault
            self.get_logger().error(f"{fault}\nNo costmap: the robot stops.")

    # -- CostmapSource: around the robot, and without a footprint -----------------

    footprint: Footprint | None = None

    def newest_grid(self) -> OccupancyGrid | None:
        return self._newest

    def robot_on_grid(self) -> Pose2:
        return Pose2(0.0, 0.0, 0.0)

    def frame_on_grid(self, frame_id: str) -> Pose2:
        return Pose2(0.0, 0.0, 0.0)

    def clear_costmap(self, region: SquareRegion | None) -> None:
        """Clear the costmap of Nav2's name until the next scan.

        The costmap that stops the robot is not changed: what a beam hits is there.
        Without a region the obstacle layer is cleared, too.
        """
        if region is None and self._sources is not None:
            self._sources.clear()
        if self._newest is None:
            return
        cells, spec = grid_from_message(self._newest)
        cleared = cells.copy()
        cleared[... if region is None else region.mask(spec)] = FREE
        header = self._newest.header
        stamp_ns = stamp_to_ns(header.stamp)
        self._newest = grid_to_message(cleared, spec, header.frame_id, stamp_ns)
        self.publish(topics.LOCAL_COSTMAP.name, self._newest)

    def on_params_changed(self, old: CostmapParams) -> None:
        """Use the new values from the next scan on."""
        self._costmap = make_costmap(self.params)
        if self._sources is not None:
            self._sources.configure(self.params)
        self.change_rate(topics.LIDAR.name, self.params.rate_hz)
