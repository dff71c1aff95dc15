"""A node class alone: run it as listener_node.py:Listener."""

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import String


class Listener(Node):
    def __init__(self, group=None):
        super().__init__("listener")
        self.received = []
        self.create_subscription(
            String,
            "chatter",
            self.receive,
            QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE),
            callback_group=group,
        )

    def receive(self, msg):
        self.received.append(msg.data)
        self.get_logger().info(f"I heard: [{msg.data}]")
