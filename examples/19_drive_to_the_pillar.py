"""A Husky drives to a pillar: a P controller, a marker and a service that stops it.

Prints::

    after 5 s: stopped at x = 3.8 m
    after 9 s: driving at x = 4.6 m
    after 40 s: 2.0 m in front of the pillar, marker at (3.0, 0.0) in the laser frame
"""

import numpy as np

import navette
from navette.msgs.geometry_msgs.msg import Twist
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.msgs.std_srvs.srv import SetBool
from navette.msgs.visualization_msgs.msg import Marker
from navette.navigation.stack.robot import simulate_robot

GAIN = 1.5  # turn rate (rad/s) per bearing error (rad)
STOP_AT_M = 2.0


class PillarDriver(navette.Node):
    def __init__(self):
        super().__init__("pillar_driver")
        self.is_driving = True
        self.commands = self.create_publisher(Twist, "/cmd_vel", 1)
        self.markers = self.create_publisher(Marker, "~/pillar", 1)
        self.create_subscription(LaserScan, "/lidar", self.on_scan, 1)
        self.create_service(SetBool, "~/drive", self.on_drive)

    def on_drive(self, request, response):
        self.is_driving = request.data
        response.success = True
        response.message = "driving" if request.data else "stopped"
        return response

    def on_scan(self, scan):
        ranges = np.asarray(scan.ranges)
        valid = (ranges >= scan.range_min) & (ranges <= scan.range_max)
        nearest = int(np.argmin(np.where(valid, ranges, np.inf)))
        self.distance = float(ranges[nearest])
        angle = scan.angle_min + nearest * scan.angle_increment
        command = Twist()
        if self.is_driving and valid.any() and self.distance > STOP_AT_M:
            command.linear.x = min(1.0, self.distance - STOP_AT_M + 0.1)
            command.angular.z = GAIN * angle
        self.commands.publish(command)
        marker = Marker(header=scan.header, type=Marker.CYLINDER, ns="pillar")
        marker.pose.position.x = (self.distance + 1.0) * np.cos(angle)  # r = 1 m
        marker.pose.position.y = (self.distance + 1.0) * np.sin(angle)
        marker.scale.x = marker.scale.y = marker.scale.z = 2.0
        marker.color.r = marker.color.a = 1.0
        self.markers.publish(marker)


class Operator(navette.Node):
    """Stops and resumes the driver and observes it."""

    def __init__(self):
        super().__init__("operator")
        self.client = self.create_client(SetBool, "/pillar_driver/drive")
        self.create_subscription(Odometry, "/odom/filtered", self.on_odometry, 1)
        self.create_subscription(Marker, "/pillar_driver/pillar", self.on_marker, 1)

    def on_odometry(self, message):
        self.x = message.pose.pose.position.x

    def on_marker(self, message):
        self.marker = message.pose.position

    def set_driving(self, *, drive):
        future = self.client.call_async(SetBool.Request(data=drive))
        executor.spin_until_future_complete(future)
        executor.spin_for(1_000_000_000)
        return future.result().message


with navette.init(clock=navette.VirtualClock()):
    executor = navette.SingleThreadedExecutor()
    driver, operator = PillarDriver(), Operator()
    for node in (simulate_robot("pillar", "husky"), driver, operator):
        executor.add_node(node)
    executor.spin_for(4_000_000_000)
    print(f"after 5 s: {operator.set_driving(drive=False)} at x = {operator.x:.1f} m")
    executor.spin_for(3_000_000_000)
    print(f"after 9 s: {operator.set_driving(drive=True)} at x = {operator.x:.1f} m")
    executor.spin_for(31_000_000_000)
    seen = f"({operator.marker.x:.1f}, {operator.marker.y:z.1f})"
    print(
        f"after 40 s: {driver.distance:.1f} m in front of the pillar, "
        f"marker at {seen} in the laser frame"
    )
