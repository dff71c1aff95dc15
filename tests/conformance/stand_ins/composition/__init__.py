"""Components of ROS 2's C++ package ``composition`` as Python node classes.

The suite of launch_ros loads them; it needs nodes that exist, not what they do.
"""

from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):
    def __init__(self) -> None:
        super().__init__("talker")
        self._publisher = self.create_publisher(String, "chatter", 10)
        self.create_timer(1.0, lambda: self._publisher.publish(String(data="Hello")))


class Listener(Node):
    def __init__(self) -> None:
        super().__init__("listener")
        log = self.get_logger()
        self.create_subscription(
            String, "chatter", lambda m: log.info(f"I heard: [{m.data}]"), 10
        )
