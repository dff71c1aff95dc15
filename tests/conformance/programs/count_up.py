"""Publishes 1, 2, 3, … on /count, reliably, 50 per second."""

import sys

import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import Int64


class CountUp(Node):
    def __init__(self) -> None:
        super().__init__("count_up")
        self.publisher = self.create_publisher(Int64, "/count", QoSProfile(depth=2000))
        self.create_timer(0.02, self.tick)
        self.number = 0

    def tick(self) -> None:
        self.number += 1
        self.publisher.publish(Int64(data=self.number))


rclpy.init(args=sys.argv)
rclpy.spin(CountUp())
