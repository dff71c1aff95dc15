"""Measure the distance that a car drove: a node around an algorithm, and a bag.

The recording is replayed to the node in lock-step, faster than real time. A parameter
file selects the method. The built-in node does the same and more: ``navette run
odom_integrator`` beside ``navette bag play examples/data/drive.mcap``.

Prints::

    gps: 102.40 m
    vel: 102.17 m
"""

import tempfile
from pathlib import Path

import navette
from navette.bags import open_bag
from navette.msgs.gnss_driver.msg import Gps
from navette.msgs.std_msgs.msg import Float64
from navette.navigation.localization import Odometer
from navette.navigation.stack.replay import Replay

DRIVE = Path(__file__).parent / "data" / "drive.mcap"
PARAMETERS = """
trip:
  ros__parameters:
    odom_type: {}  # gps: changes of position; vel: velocity times time
"""


class Trip(navette.Node):
    """Converts messages, calls the algorithm, publishes the result."""

    def __init__(self, context):
        super().__init__("trip", context=context)
        self.odom_type = self.declare_parameter("odom_type", "gps").value
        if self.odom_type not in ("gps", "vel"):
            raise ValueError(f"odom_type {self.odom_type!r}: expected gps or vel")
        self.odometer = Odometer(max_gap_ns=2_000_000_000)
        self.publisher = self.create_publisher(Float64, "~/distance", 10)
        self.create_subscription(Gps, "/gnss_driver/odometry", self.on_gps, 1)
        self.create_timer(0.1, self.on_timer)

    def on_gps(self, message):
        stamp_ns = navette.Time.from_msg(message.header.stamp).nanoseconds
        position = message.localization.position
        velocity = message.localization.linear_velocity
        if self.odom_type == "gps":
            self.odometer.step_position((position.x, position.y, position.z), stamp_ns)
        else:
            self.odometer.step_velocity((velocity.x, velocity.y, velocity.z), stamp_ns)

    def on_timer(self):
        self.publisher.publish(Float64(data=self.odometer.distance))


with tempfile.TemporaryDirectory() as folder, open_bag(DRIVE) as bag:
    for odom_type in ("gps", "vel"):
        file = Path(folder, "trip.yaml")
        file.write_text(PARAMETERS.format(odom_type))
        replay = Replay(bag, [Trip], arguments=["--ros-args", "--params-file", file])
        replay.run()
        print(f"{odom_type}: {replay.nodes[0].odometer.distance:.2f} m")
        replay.close()
