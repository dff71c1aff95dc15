"""A timer: publish "Hello, ROS 2!" on /test_topic every 500 ms.

In real time, without the virtual clock, inspect it from a second terminal:
``navette topic echo /test_topic``.

Prints::

    0.5 s: Hello, ROS 2!
    1.0 s: Hello, ROS 2!
    1.5 s: Hello, ROS 2!
    cancelled: no further messages
"""

import navette
from navette.msgs.std_msgs.msg import String


class WarmUp(navette.Node):
    def __init__(self):
        super().__init__("warm_up")
        self.publisher = self.create_publisher(String, "/test_topic", 10)
        self.timer = self.create_timer(0.5, self.on_timer)

    def on_timer(self):
        self.publisher.publish(String(data="Hello, ROS 2!"))


def show(message):
    seconds = node.get_clock().now().nanoseconds / 1e9
    print(f"{seconds:.1f} s: {message.data}")


with navette.init(clock=navette.VirtualClock()):
    node = WarmUp()
    node.create_subscription(String, "/test_topic", show, 10)
    executor = navette.SingleThreadedExecutor()
    executor.add_node(node)
    executor.spin_for(1_700_000_000)
    node.timer.cancel()
    executor.spin_for(5_000_000_000)
    print("cancelled: no further messages")
