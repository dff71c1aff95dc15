"""A talker and a listener on one topic.

The virtual clock jumps from event to event: two seconds pass in an instant. Without it
the nodes run in real time.

Prints::

    received: Hello, world 1
    received: Hello, world 2
    received: Hello, world 3
    received: Hello, world 4
"""

import navette
from navette.msgs.std_msgs.msg import String


class Talker(navette.Node):
    def __init__(self):
        super().__init__("talker")
        self.publisher = self.create_publisher(String, "chatter", 10)
        self.create_timer(0.5, self.on_timer)
        self.count = 0

    def on_timer(self):
        self.count += 1
        self.publisher.publish(String(data=f"Hello, world {self.count}"))


class Listener(navette.Node):
    def __init__(self):
        super().__init__("listener")
        self.create_subscription(String, "chatter", self.on_message, 10)

    def on_message(self, message):
        print("received:", message.data)


with navette.init(clock=navette.VirtualClock()):
    executor = navette.SingleThreadedExecutor()
    executor.add_node(Talker())
    executor.add_node(Listener())
    executor.spin_for(2_000_000_000)  # nanoseconds
