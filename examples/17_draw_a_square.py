"""Drive a square with velocity commands and read the pose, as with turtlesim.

Fields that a command omits stay zero. On the command line:
``navette topic pub /cmd_vel geometry_msgs/Twist '{linear: {x: 0.2}}' -r 10``.

Prints::

    at (1.0, 0.0)
    at (1.0, 1.0)
    at (0.0, 1.0)
    at (0.0, 0.0)
"""

import math

import navette
from navette.msgs import from_dict
from navette.msgs.geometry_msgs.msg import Twist
from navette.msgs.nav_msgs.msg import Odometry
from navette.navigation.stack.robot import simulate_robot

GO = from_dict(Twist, {"linear": {"x": 0.2}})  # m/s
TURN = from_dict(Twist, {"angular": {"z": 0.5}})  # rad/s
SIDE = [(GO, 1.0 / 0.2), (TURN, math.pi / 2 / 0.5)]  # command, seconds


class Turtle(navette.Node):
    def __init__(self):
        super().__init__("turtle")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 1)
        self.create_subscription(Odometry, "/odom", self.on_odometry, 1)
        self.position = None

    def on_odometry(self, message):
        self.position = message.pose.pose.position

    def drive(self, command, seconds):
        """Publish a command for some time, then stop the robot."""
        for _ in range(round(seconds * 20)):
            self.publisher.publish(command)
            executor.spin_for(50_000_000)
        self.publisher.publish(Twist())
        executor.spin_for(500_000_000)


with navette.init(clock=navette.VirtualClock()):
    executor = navette.SingleThreadedExecutor()
    turtle = Turtle()
    executor.add_node(simulate_robot("empty", "turtlebot3_burger"))
    executor.add_node(turtle)
    for _ in range(4):
        for command, seconds in SIDE:
            turtle.drive(command, seconds)
            if command is GO:
                x, y = turtle.position.x, turtle.position.y
                print(f"at ({round(x, 1) + 0:.1f}, {round(y, 1) + 0:.1f})")
