"""Queue depth: a node that reacts needs the newest message, not every message.

Three measurements arrive at once. The brake, with a depth of 1, receives only the last;
the log, with a depth of 10, receives all.

Prints::

    log: 2.0 m
    brake: stop at 0.4 m
    log: 1.2 m
    log: 0.4 m
"""

import navette
from navette.msgs.geometry_msgs.msg import Twist
from navette.msgs.sensor_msgs.msg import Range


class Sensor(navette.Node):
    def __init__(self):
        super().__init__("sensor")
        self.publisher = self.create_publisher(Range, "range", 10)
        self.create_timer(1.0, self.measure)

    def measure(self):
        for distance in (2.0, 1.2, 0.4):
            self.publisher.publish(Range(range=distance))


class Log(navette.Node):
    def __init__(self):
        super().__init__("log")
        self.create_subscription(Range, "range", self.on_range, 10)

    def on_range(self, message):
        print(f"log: {message.range:.1f} m")


class Brake(navette.Node):
    def __init__(self):
        super().__init__("brake")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 1)
        self.create_subscription(Range, "range", self.on_range, 1)

    def on_range(self, message):
        command = Twist()
        command.linear.x = 0.5 if message.range > 1.0 else 0.0
        self.publisher.publish(command)
        word = "drive" if command.linear.x else "stop"
        print(f"brake: {word} at {message.range:.1f} m")


with navette.init(clock=navette.VirtualClock()):
    executor = navette.SingleThreadedExecutor()
    for node in (Sensor(), Log(), Brake()):
        executor.add_node(node)
    executor.spin_for(1_500_000_000)
