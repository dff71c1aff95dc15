"""The control node in a graph, with a simulated robot around it."""

import math

import numpy as np
from control_plant import Plant

from navette.geometry import Pose2, quaternion_from_yaw
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.geometry_msgs.msg import PoseStamped, Quaternion, Twist
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry, Path
from navette.navigation.control.node import ControlNode
from navette.runtime import Parameter
from navette.runtime.testing import GraphHarness
from navette.runtime.time import ns_to_stamp


class World:
    """A robot in a graph: /cmd_vel_nav in, odometry and costmap out, planner alive."""

    def __init__(self, graph: GraphHarness, **params: object) -> None:
        self.graph = graph
        self.plant = Plant(Pose2(0.0, 0.0, 0.0))
        self.odometry = self.lidar = self.planner = True
        self.planner_publishes = "following"
        self.wall_x: float | None = None  # across the x axis of the map
        self.resolution = 0.1  # published resolution of the costmap
        self.node = graph.add(
            ControlNode(
                context=graph.context,
                parameter_overrides=[
                    Parameter(name, value=value) for name, value in params.items()
                ],
            )
        )
        self.commands = graph.collect("/cmd_vel_nav", "geometry_msgs/msg/Twist")
        self.status = graph.collect(
            "/control/status", "diagnostic_msgs/msg/DiagnosticStatus", latched=True
        )
        self._command = Twist()
        timers = ((0.05, self._move), (0.1, self._scan), (0.5, self._plan))
        for period, callback in timers:
            graph.node.create_timer(period, callback)
        graph.node.create_subscription(Twist, "/cmd_vel_nav", self._obey, 10)

    def send_path(self, poses: np.ndarray, frame: str = "map") -> None:
        msg = Path()
        msg.header.frame_id = frame
        for x, y, yaw in poses:
            stamped = PoseStamped()
            stamped.pose.position.x, stamped.pose.position.y = x, y
            qx, qy, qz, qw = quaternion_from_yaw(yaw)
            stamped.pose.orientation = Quaternion(x=qx, y=qy, z=qz, w=qw)
            msg.poses.append(stamped)
        self.graph.publish("/path", msg)

    @property
    def state(self) -> str:
        return str(self.status.last.message)

    @property
    def states(self) -> list[str]:
        names = [m.message for m in self.status.messages]
        return [b for a, b in zip(["", *names], names, strict=False) if a != b]

    def _obey(self, msg: Twist) -> None:
        self._command = msg

    def _move(self) -> None:
        self.plant.drive(self._command.linear.x, self._command.angular.z, 0.05)
        if not self.odometry:
            return
        msg = Odometry(child_frame_id="base_link")
        msg.header.frame_id = "map"
        msg.header.stamp = ns_to_stamp(self.graph.now_ns)
        pose = self.plant.pose
        msg.pose.pose.position.x, msg.pose.pose.position.y = pose.x, pose.y
        x, y, z, w = quaternion_from_yaw(pose.yaw)
        msg.pose.pose.orientation = Quaternion(x=x, y=y, z=z, w=w)
        msg.twist.twist.linear.x = self.plant.speed
        msg.twist.twist.angular.z = self.plant.turn_rate
        self.graph.publish("/odom/filtered", msg)

    def _scan(self) -> None:
        """A costmap in the robot's frame, 8 m wide, origin a corner."""
        if not self.lidar:
            return
        cost = np.zeros((80, 80), np.int8)
        if self.wall_x is not None:
            column = math.floor((self.wall_x - self.plant.pose.x + 4.0) / 0.1)
            if 0 <= column < 80:
                cost[:, column] = 100
        msg = OccupancyGrid()
        msg.header.frame_id = "base_link"
        msg.header.stamp = ns_to_stamp(self.graph.now_ns)
        msg.info.resolution = self.resolution
        msg.info.width = msg.info.height = 80
        msg.info.origin.position.x = msg.info.origin.position.y = -4.0
        msg.data = cost.ravel()
        self.graph.publish("/costmap", msg)

    def _plan(self) -> None:
        if self.planner:
            status = DiagnosticStatus(message=self.planner_publishes)
            self.graph.publish("/planner/status", status, latched=True)
