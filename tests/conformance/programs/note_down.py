"""Prints each number that it hears on /count."""

import sys

import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import Int64


class NoteDown(Node):
    def __init__(self) -> None:
        super().__init__("note_down")
        self.create_subscription(Int64, "/count", self.note, QoSProfile(depth=2000))

    def note(self, message: Int64) -> None:
        print(message.data, flush=True)  # noqa: T201


rclpy.init(args=sys.argv)
rclpy.spin(NoteDown())
