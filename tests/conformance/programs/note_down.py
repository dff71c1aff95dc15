"""Prints each number on /count, and "alone" without a matched publisher."""

import sys

import rclpy
from rclpy.event_handler import QoSSubscriptionMatchedInfo, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import Int64


class NoteDown(Node):
    def __init__(self) -> None:
        super().__init__("note_down")
        self.create_subscription(
            Int64,
            "/count",
            self.note,
            QoSProfile(depth=2000),
            event_callbacks=SubscriptionEventCallbacks(matched=self.look),
        )

    def note(self, message: Int64) -> None:
        print(message.data, flush=True)  # noqa: T201 - read by the test

    def look(self, info: QoSSubscriptionMatchedInfo) -> None:
        if not info.current_count:
            print("alone", flush=True)  # noqa: T201 - read by the test


rclpy.init(args=sys.argv)
rclpy.spin(NoteDown())
