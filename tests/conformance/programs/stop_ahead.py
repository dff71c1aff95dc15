"""Drives ahead and stops before an obstacle, as programs for a TurtleBot3 do.

The first and the last quarter of the ranges are those ahead: the scan begins ahead.
Argument ``stamped``: commands are TwistStamped, as TurtleBot3 expects from Jazzy on.
"""

import sys

import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan

STOP_M = 0.5


class StopAhead(Node):
    def __init__(self, stamped: bool) -> None:
        super().__init__("stop_ahead")
        self.ranges: list[float] = []
        kind = TwistStamped if stamped else Twist
        self.commands = self.create_publisher(kind, "cmd_vel", 10)
        self.create_subscription(
            LaserScan, "scan", self.on_scan, qos_profile_sensor_data
        )
        self.create_timer(0.1, self.on_timer)

    def on_scan(self, scan: LaserScan) -> None:
        self.ranges = list(scan.ranges)

    def on_timer(self) -> None:
        if not self.ranges:
            return
        quarter = len(self.ranges) // 4
        nearest = min(*self.ranges[:quarter], *self.ranges[-quarter:])
        twist = Twist()
        if nearest >= STOP_M:
            twist.linear.x = 0.2
        else:
            self.get_logger().info("obstacle ahead", throttle_duration_sec=2)
        stamped = self.commands.msg_type is TwistStamped
        self.commands.publish(TwistStamped(twist=twist) if stamped else twist)


rclpy.init(args=sys.argv)
rclpy.spin(StopAhead("stamped" in sys.argv))
