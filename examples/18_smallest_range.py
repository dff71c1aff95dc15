"""Find the smallest valid range of a laser scan: a Husky in front of a pillar.

Topic and queue depth are parameters, so that the node also works with another robot's
/scan. A range outside range_min … range_max (no hit, too near, NaN) is invalid.

Prints::

    /lidar, depth 1: nearest object 19.3 m away, 14.5° to the left
"""

import math

import numpy as np

import navette
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.navigation.stack.robot import simulate_robot


class NearestObject(navette.Node):
    def __init__(self):
        super().__init__("nearest_object")
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
            f"{self.topic}, depth {self.queue_size}: nearest object "
            f"{ranges[nearest]:.1f} m away, {angle:.1f}° to the left"
        )


arguments = "--ros-args -p topic:=/lidar -p nearest_object:queue_size:=1".split()
with navette.init(args=arguments, clock=navette.VirtualClock()):
    executor = navette.SingleThreadedExecutor()
    executor.add_node(simulate_robot("pillar", "husky"))
    executor.add_node(NearestObject())
    executor.spin_for(50_000_000)
