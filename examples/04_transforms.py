"""Transforms: the position of a laser hit in the map, now and at an earlier time.

The laser is mounted 0.3 m ahead of the base, which drives along the map's y axis at
1 m/s. The hit is 2 m ahead of the laser.

Prints::

    at 1.00 s: y = 3.30 m
    at 0.25 s: y = 2.55 m
"""

import math

import navette
from navette.msgs.geometry_msgs.msg import PointStamped, TransformStamped


def transform(parent, child, *, x=0.0, y=0.0, yaw=0.0):
    """Return parent_T_child, planar."""
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    message.transform.translation.x = x
    message.transform.translation.y = y
    message.transform.rotation.z = math.sin(yaw / 2)
    message.transform.rotation.w = math.cos(yaw / 2)
    return message


class Robot(navette.Node):
    def __init__(self):
        super().__init__("robot")
        fixed = navette.StaticTransformBroadcaster(self)
        fixed.sendTransform(transform("base_link", "laser", x=0.3))
        self.moving = navette.TransformBroadcaster(self)
        self.create_timer(0.1, self.drive)

    def drive(self):
        now = self.get_clock().now()
        y = now.nanoseconds / 1e9
        map_T_base = transform("map", "base_link", y=y, yaw=math.pi / 2)
        map_T_base.header.stamp = now.to_msg()
        self.moving.sendTransform(map_T_base)


with navette.init(clock=navette.VirtualClock()):
    robot, watcher = Robot(), navette.Node("watcher")
    buffer = navette.Buffer(node=watcher)
    listener = navette.TransformListener(buffer, watcher)
    executor = navette.SingleThreadedExecutor()
    executor.add_node(robot)
    executor.add_node(watcher)
    executor.spin_for(1_000_000_000)
    for seconds in (1.0, 0.25):  # the second is interpolated between two poses
        seen = PointStamped()
        seen.header.frame_id = "laser"
        seen.header.stamp = navette.Time(nanoseconds=round(seconds * 1e9)).to_msg()
        seen.point.x = 2.0
        point = buffer.transform(seen, "map").point
        print(f"at {seconds:.2f} s: y = {point.y:.2f} m")
