"""A stationary robot and a map around the planner node."""

import numpy as np
from planning_worlds import empty_map

from navette.geometry import Pose2, quaternion_from_yaw, yaw_of
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from navette.msgs.geometry_msgs.msg import (
    Point,
    PointStamped,
    PoseStamped,
    Quaternion,
)
from navette.msgs.nav_msgs.msg import Odometry
from navette.navigation.grids import (
    NO_CELLS,
    CellWindow,
    grid_to_message,
    window_to_message,
)
from navette.navigation.grids.spec import Cells
from navette.navigation.planning.node import PlannerNode
from navette.runtime import Parameter
from navette.runtime.testing import GraphHarness
from navette.runtime.time import ns_to_stamp


class World:
    """A stationary robot, a map, and probes on /path and /planner/status."""

    def __init__(self, graph: GraphHarness, **params: object) -> None:
        self.graph = graph
        self.occupancy, self.spec = empty_map(10, 8)
        self.pose, self.odometry = Pose2(1, 4, 0), True
        self.sent_ns = self.map_ns = 0
        overrides = [Parameter(name, value=value) for name, value in params.items()]
        self.node = graph.add(
            PlannerNode(context=graph.context, parameter_overrides=overrides)
        )
        self.paths = graph.collect("/path", "nav_msgs/msg/Path")
        self.reports = graph.collect("/planner/status", DiagnosticStatus, latched=True)
        graph.node.create_timer(0.1, self._move)

    def send_map(self, frame: str = "map", stamp_ns: int | None = None) -> None:
        self.map_ns = self.graph.now_ns if stamp_ns is None else stamp_ns
        msg = grid_to_message(self.occupancy.copy(), self.spec, frame, self.map_ns)
        self.graph.publish("/map", msg, latched=True)

    def begin_updates(self) -> None:
        """Publish the update of the whole map, which later ones follow."""
        self.send_part(NO_CELLS, stamp_ns=self.map_ns)

    def send_part(
        self,
        window: CellWindow,
        frame: str = "map",
        stamp_ns: int | None = None,
        cells: Cells | None = None,
    ) -> None:
        """Publish a part of the map, or ``cells`` at that place."""
        self.sent_ns = self.graph.now_ns if stamp_ns is None else stamp_ns
        if cells is None:
            msg = window_to_message(self.occupancy, window, frame, self.sent_ns)
        else:
            whole = CellWindow.whole(cells.shape)
            msg = window_to_message(cells, whole, frame, self.sent_ns)
            msg.x, msg.y = window.first_column, window.first_row
        self.graph.publish("/map_updates", msg, latched=True)

    def send(self, x: float, y: float, frame: str = "map") -> None:
        msg = PointStamped(point=Point(x=x, y=y))
        msg.header.frame_id = frame
        self.graph.publish("/goal_point", msg)

    def send_pose(self, x: float, y: float, yaw: float, frame: str = "map") -> None:
        msg = PoseStamped()
        msg.header.frame_id = frame
        msg.pose.position = Point(x=x, y=y)
        qx, qy, qz, qw = quaternion_from_yaw(yaw)
        msg.pose.orientation = Quaternion(x=qx, y=qy, z=qz, w=qw)
        self.graph.publish("/goal_pose", msg)

    def commander(self, name: str, masked: str = "") -> None:
        values = [KeyValue(key="masked_topics", value=masked)]
        status = DiagnosticStatus(message=name, values=values)
        self.graph.publish("/commander", status, latched=True)
        self.graph.run_for(0.01)

    def ready(self) -> "World":
        self.send_map()
        self.graph.run_for(0.3)
        return self

    @property
    def message(self) -> str:
        return str(self.reports.last.message)

    @property
    def values(self) -> dict[str, str]:
        return {pair.key: pair.value for pair in self.reports.last.values}

    def last_path(self) -> np.ndarray:
        rows = [
            (p.pose.position.x, p.pose.position.y, yaw_of(_xyzw(p.pose.orientation)))
            for p in self.paths.last.poses
        ]
        return np.array(rows).reshape(-1, 3)

    def _move(self) -> None:
        if not self.odometry:
            return
        msg = Odometry(child_frame_id="base_link")
        msg.header.frame_id = "map"
        msg.header.stamp = ns_to_stamp(self.graph.now_ns)
        msg.pose.pose.position = Point(x=float(self.pose.x), y=float(self.pose.y))
        qx, qy, qz, qw = quaternion_from_yaw(self.pose.yaw)
        msg.pose.pose.orientation = Quaternion(x=qx, y=qy, z=qz, w=qw)
        self.graph.publish("/odom/filtered", msg)


def _xyzw(q: Quaternion) -> tuple[float, float, float, float]:
    return q.x, q.y, q.z, q.w
