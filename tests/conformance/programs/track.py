"""Prints the pose of the simulated robot and the state of its goal as JSON.

Run as a program: the tests read its output.
"""

import json
import sys

import rclpy
from diagnostic_msgs.msg import DiagnosticStatus
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.time import Time


class Track(Node):
    def __init__(self) -> None:
        super().__init__("track")
        self.create_subscription(Odometry, "/ground_truth", self.on_truth, 1)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(
            DiagnosticStatus, "/planner/status", self.on_status, latched
        )

    def on_truth(self, message: Odometry) -> None:
        position, speed = message.pose.pose.position, message.twist.twist.linear.x
        time = Time.from_msg(message.header.stamp).nanoseconds / 1e9
        self.say(time=time, x=position.x, y=position.y, speed=speed)

    def on_status(self, message: DiagnosticStatus) -> None:
        self.say(planner=message.message)

    def say(self, **what: object) -> None:
        print(json.dumps(what), flush=True)  # noqa: T201 - read by the test


rclpy.init(args=sys.argv)
rclpy.spin(Track())
