"""A Husky looks at a pillar: the smallest valid range of each scan.

Topic and queue size are parameters, so that the same node reads another robot's /scan.
A range outside range_min … range_max (nothing hit, too near, not a number) is no
measurement, however small it is.

Prints::

    /lidar, queue of 1: nearest thing 19.3 m away, 14.5° to the left
"""

import math

import numpy as np

import navette
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.navigation.stack.robot import simulate_robot


class NearestThing(navette.Node):
    def __init__(self):
        super().__init__("nearest_thing")
        self.topic = self.declare_parameter("topic", "/scan").value
        self.queue_size = self.declare_parameter("queue_size", 10).value
        self.create_subscription(LaserScan, self.topic, self.on_scan, self.queue_size)

    def on_scan(self, scan):
        ranges = np.asarray(scan.ranges)
        valid = (ranges >= scan.range_min) & (ranges <= scan.range_max)
        if not valid.any():
            print("nothing in range")
            return
        nearest = int(np.argmin(np.where(valid, ranges, np.inf)))
        angle = math.degrees(scan.angle_min + nearest * scan.angle_increment)
        print(
            f"{self.topic}, queue of {self.queue_size}: nearest thing "
            f"{ranges[nearest]:.1f} m away, {angle:.1f}° to the left"
        )


arguments = "--ros-args -p topic:=/lidar -p nearest_thing:queue_size:=1".split()
with navette.init(args=arguments, clock=navette.VirtualClock()):
    executor = navette.SingleThreadedExecutor()
    executor.add_node(simulate_robot("pillar", "husky"))
    executor.add_node(NearestThing())
    executor.spin_for(50_000_000)
