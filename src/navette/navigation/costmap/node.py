"""The costmap node: scan → costmap.

Before the first scan it publishes nothing; one costmap for each scan, in the scan's
frame, with its stamp. A scan that makes no sense is logged and gives no costmap, so
what depends on costmaps sees them go stale.
"""

from typing import Any, ClassVar

import numpy as np

from navette import topics
from navette.errors import InvalidValueError
from navette.grids import grid_to_message
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.navigation.costmap.params import CostmapParams
from navette.navigation.costmap.scan_costmap import Scan, ScanCostmap
from navette.runtime import Input, Output, StageNode, stamp_to_ns


class CostmapNode(StageNode):
    """Turns each scan into a costmap around the sensor."""

    PARAMS = CostmapParams
    INPUTS: ClassVar = (
        Input(
            topic=topics.LIDAR.name,
            type=topics.LIDAR.type,
            role="what the laser scanner sees",
            rate_hz=10.0,
            timeout_s=0.5,
            callback="on_scan",
        ),
    )
    OUTPUTS: ClassVar = (
        Output(
            topic=topics.COSTMAP.name,
            type=topics.COSTMAP.type,
            role="what is dangerous around the robot",
            rate_hz=10.0,
        ),
    )

    params: CostmapParams

    def __init__(self, node_name: str = "costmap", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._costmap = ScanCostmap(self.params)
        self._costmap.warm_up()

    def on_scan(self, msg: LaserScan) -> None:
        """Publish the scan's costmap."""
        try:
            scan = Scan(
                np.asarray(msg.ranges),
                msg.angle_min,
                msg.angle_increment,
                msg.range_min,
                msg.range_max,
            )
        except InvalidValueError as error:
            self.get_logger().error(f"scan not used: {error}", throttle_duration_sec=5)
            return
        cells = self._costmap.build(scan)
        stamp_ns = stamp_to_ns(msg.header.stamp)
        frame_id = msg.header.frame_id
        message = grid_to_message(cells, self._costmap.spec, frame_id, stamp_ns)
        self.publish(topics.COSTMAP.name, message)

    def on_params_changed(self, old: CostmapParams) -> None:
        """The next scan is made into a costmap with the new values."""
        self._costmap = ScanCostmap(self.params)
