"""Two nodes meet on a topic: one talks, the other listens.

The virtual clock jumps from event to event, so two seconds take no time. Leave it out
and the nodes talk in real time.

Prints::

    heard: Hello, world 1
    heard: Hello, world 2
    heard: Hello, world 3
    heard: Hello, world 4
"""

import navette
from navette.msgs.std_msgs.msg import String


class Talker(navette.Node):
    def __init__(self):
        super().__init__("talker")
        self.publisher = self.create_publisher(String, "chatter", 10)
        self.create_timer(0.5, self.talk)
        self.count = 0

    def talk(self):
        self.count += 1
        self.publisher.publish(String(data=f"Hello, world {self.count}"))


class Listener(navette.Node):
    def __init__(self):
        super().__init__("listener")
        self.create_subscription(String, "chatter", self.hear, 10)

    def hear(self, message):
        print("heard:", message.data)


with navette.init(clock=navette.VirtualClock()):
    executor = navette.SingleThreadedExecutor()
    executor.add_node(Talker())
    executor.add_node(Listener())
    executor.spin_for(2_000_000_000)  # nanoseconds
