"""The node ``zones``: filter masks in, keep-out zones and speed limits out.

Masks come from files, which the node publishes as Nav2's map_server and
costmap_filter_info_server do, or from other nodes that publish these. Without a mask
the node publishes nothing.
"""

import math
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from navette.errors import InvalidInputError, InvalidValueError, NavetteError
from navette.geometry.map_files import read_occupancy_map
from navette.geometry.messages import header
from navette.msgs import topics
from navette.msgs.nav2_msgs.msg import CostmapFilterInfo, SpeedLimit
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.navigation.grids import GridSpec, grid_from_message, grid_to_message
from navette.navigation.grids.checks import check_frame
from navette.navigation.mapping.zones.masks import FilterMask
from navette.navigation.mapping.zones.params import ZonesParams
from navette.runtime import Input, Output, StageNode
from navette.runtime.qos import DurabilityPolicy, QoSProfile
from navette.runtime.stage.odometry import PoseTracker
from navette.runtime.subscription import Subscription

_KEEP_OUT, _PERCENT, _ABSOLUTE = 0, 1, 2  # types of CostmapFilterInfo
_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_NO_LIMIT = 0.0  # of SpeedLimit
_LEAST_LIMIT = 0.01  # 0 would be no limit


class ZonesNode(StageNode):
    """Publish keep-out zones, and the speed limit where the robot is."""

    PARAMS = ZonesParams
    FIXED_AT_START: ClassVar = ("keepout_file", "speed_file")
    INPUTS: ClassVar = (
        Input.of(
            topics.KEEPOUT_INFO,
            "topic and scale of the mask of keep-out zones",
            callback="on_keepout_info",
        ),
        Input.of(
            topics.SPEED_INFO,
            "topic and scale of the mask of speed zones",
            callback="on_speed_info",
        ),
        Input.of(
            topics.ODOMETRY, "where the robot is", rate_hz=10.0, callback="on_odometry"
        ),
    )
    OUTPUTS: ClassVar = (
        Output.of(topics.KEEPOUT_MASK, "mask of the file of keep-out zones"),
        Output.of(topics.SPEED_MASK, "mask of the file of speed zones"),
        Output.of(topics.KEEPOUT_INFO, "about this mask"),
        Output.of(topics.SPEED_INFO, "about that mask"),
        Output.of(topics.KEEPOUT_ZONES, "cells that the robot must not touch: 100"),
        Output.of(topics.SPEED_LIMIT, "limit where the robot is, on change"),
    )

    params: ZonesParams

    def __init__(self, node_name: str = "zones", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        params = self.params
        self._tracker = PoseTracker(self, params.base_frame, params.map_frame)
        self._masks: dict[int, Subscription[Any]] = {}  # by the type of the filter
        self._speeds: FilterMask | None = None
        self._in_percent = True
        self._published = _NO_LIMIT, True
        if params.keepout_file:
            info = CostmapFilterInfo(type=_KEEP_OUT, base=0.0, multiplier=1.0)
            self._serve(
                params.keepout_file, info, topics.KEEPOUT_MASK, topics.KEEPOUT_INFO
            )
        if params.speed_file:
            info = CostmapFilterInfo(
                type=_PERCENT if params.speed_in_percent else _ABSOLUTE,
                base=params.speed_base,
                multiplier=params.speed_multiplier,
            )
            self._serve(params.speed_file, info, topics.SPEED_MASK, topics.SPEED_INFO)

    def on_keepout_info(self, msg: CostmapFilterInfo) -> None:
        """Subscribe to the mask of keep-out zones."""
        if msg.type != _KEEP_OUT:
            raise InvalidInputError("wrong_type", f"type {msg.type}; expected 0")
        if (msg.base, msg.multiplier) != (0.0, 1.0):
            self.get_logger().warning(
                f"keep-out zones: base {msg.base:g} and multiplier {msg.multiplier:g} "
                "are not used; expected 0 and 1"
            )
        self._subscribe_to_mask(msg, self._on_keepout_mask)

    def on_speed_info(self, msg: CostmapFilterInfo) -> None:
        """Subscribe to the mask of speed zones."""
        if msg.type not in (_PERCENT, _ABSOLUTE):
            raise InvalidInputError("wrong_type", f"type {msg.type}; expected 1 or 2")
        self._subscribe_to_mask(msg, self._on_speed_mask)

    def on_odometry(self, msg: Odometry) -> None:
        """Publish the speed limit where the robot is, if it changed."""
        if self._speeds is None or not self._tracker.update(msg):
            return
        pose = self._tracker.latest
        assert pose is not None, "the tracker accepted the odometry"
        limit = self._limit_at(self._speeds, pose.x, pose.y)
        if (limit, self._in_percent) != self._published:
            self._published = limit, self._in_percent
            frame = header(self._now_ns(), self.params.map_frame)
            message = SpeedLimit(
                header=frame, percentage=self._in_percent, speed_limit=limit
            )
            self.publish(topics.SPEED_LIMIT.name, message)

    def on_time_jump(self) -> None:
        """Drop the pose."""
        self._tracker.reset()

    def _limit_at(self, mask: FilterMask, x: float, y: float) -> float:
        """Return the limit at a point; as in Nav2, a cell of 0 has none."""
        value = mask.value_at(x, y)
        if value is None or mask.cell_at(x, y) == 0:
            return _NO_LIMIT
        if self._in_percent and value >= 100.0:
            return _NO_LIMIT
        return max(_LEAST_LIMIT, value)

    def _serve(
        self,
        file: str,
        info: CostmapFilterInfo,
        mask: topics.StackTopic,
        about: topics.StackTopic,
    ) -> None:
        """Publish a file's mask and the info about it."""
        read = read_occupancy_map(Path(file).expanduser())
        height, width = read.cells.shape
        spec = GridSpec(read.resolution, width, height, read.origin)
        now_ns, frame = self._now_ns(), self.params.map_frame
        self.hand_over(mask.name, grid_to_message(read.cells, spec, frame, now_ns))
        info.header = header(now_ns, frame)
        info.filter_mask_topic = self.resolve_topic_name(mask.name)
        self.publish(about.name, info)

    def _subscribe_to_mask(self, info: CostmapFilterInfo, use: Any) -> None:
        if not (math.isfinite(info.base) and math.isfinite(info.multiplier)):
            raise InvalidInputError("not_finite", "base or multiplier")
        kind = min(info.type, _PERCENT)

        def receive(msg: OccupancyGrid) -> None:
            check_frame("filter mask", msg.header.frame_id, self.params.map_frame)
            try:
                cells, spec = grid_from_message(msg)
            except InvalidValueError as error:
                raise InvalidInputError("out_of_range", str(error)) from None
            use(FilterMask(cells, spec, info.base, info.multiplier), info)

        try:
            mask = self.create_subscription(
                OccupancyGrid, info.filter_mask_topic, receive, _LATCHED, shared=True
            )
        except NavetteError as error:  # not a name, or a topic of another type
            text = f"filter_mask_topic: {error}"
            raise InvalidInputError("invalid_topic", text) from None
        former, self._masks[kind] = self._masks.get(kind), mask
        if former is not None:
            self.destroy_subscription(former)

    def _on_keepout_mask(self, mask: FilterMask, info: CostmapFilterInfo) -> None:
        cells = mask.keep_out(self.params.lethal_value)
        frame = self.params.map_frame
        zones = grid_to_message(cells, mask.spec, frame, self._now_ns())
        self.hand_over(topics.KEEPOUT_ZONES.name, zones)
        self.get_logger().info(f"keep-out zones: {np.count_nonzero(cells)} cells")

    def _on_speed_mask(self, mask: FilterMask, info: CostmapFilterInfo) -> None:
        self._speeds, self._in_percent = mask, info.type == _PERCENT
        self.get_logger().info(f"speed zones on {info.filter_mask_topic}")

    def _now_ns(self) -> int:
        return self.get_clock().now_ns
