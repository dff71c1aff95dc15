"""Write drive.mcap, the recording of the examples and the tutorial.

    python examples/data/make_drive.py examples/data/drive.mcap

A small car drives through a few streets for 60 s. It has a GNSS receiver (position,
velocity; less accurate as NavSatFix), wheel encoders and an IMU with a biased rate.
The same seed gives the same file, byte for byte.
"""

import math
import sys
from pathlib import Path

import numpy as np
from geographiclib.geodesic import Geodesic

from navette.bags import OfferedQos
from navette.bags.bag import BagMessage, BagTopic
from navette.bags.writing import open_writer
from navette.geometry import quaternion_from_yaw
from navette.msgs import definition_text, serialize, type_hash
from navette.msgs.geometry_msgs.msg import Quaternion, TransformStamped, Vector3
from navette.msgs.gnss_driver.msg import Gps
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.sensor_msgs.msg import Imu, NavSatFix
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.runtime import ns_to_stamp

START_NS = 1_760_000_000_000_000_000
EAST_M, NORTH_M, HEIGHT_M = 294_000.0, 5_070_000.0, 62.0  # UTM, zone 18
LATITUDE_DEG, LONGITUDE_DEG = 45.75, -73.65
# Duration (s), speed (m/s) and turn rate (rad/s) of each segment.
SEGMENTS = (
    (2, 0.0, 0.0),
    (10, 2.0, 0.0),
    (4, 1.6, math.pi / 8),
    (8, 2.0, 0.0),
    (4, 1.6, math.pi / 8),
    (6, 2.0, 0.0),
    (4, 1.6, -math.pi / 8),
    (5, 2.0, 0.0),
    (4, 1.6, math.pi / 8),
    (6, 2.0, 0.0),
    (4, 1.6, math.pi / 8),
    (3, 0.0, 0.0),
)
STEP_S = 0.01
LATCHED = OfferedQos(durability="transient_local", depth=1)


def drive():
    """Return (N, 6) every 10 ms: x, y, z (m), yaw (rad), m/s, rad/s."""
    rows = []
    x = y = yaw = speed = rate = 0.0
    for seconds, target_speed, target_rate in SEGMENTS:
        for _ in range(round(seconds / STEP_S)):
            rows.append((x, y, 0.5 * math.sin(x / 20), yaw, speed, rate))
            speed += STEP_S * (target_speed - speed) / 0.4
            rate += STEP_S * (target_rate - rate) / 0.15
            x += STEP_S * speed * math.cos(yaw)
            y += STEP_S * speed * math.sin(yaw)
            yaw += STEP_S * rate
    return np.array(rows)


class Recording:
    """Collects messages of several topics; :meth:`write` sorts them by stamp."""

    def __init__(self):
        self.messages = []
        self.topics = {}

    def add(self, name, stamp_ns, message):
        kind = type(message)._type_name_
        if name not in self.topics:
            self.topics[name] = BagTopic(
                name,
                kind,
                definition_text(kind),
                type_hash(kind),
                (LATCHED if name == "/tf_static" else OfferedQos(),),
            )
        topic = self.topics[name]
        self.messages.append(BagMessage(topic, stamp_ns, serialize(message)))

    def write(self, path):
        writer = open_writer(path, overwrite=True)
        for message in sorted(self.messages, key=lambda each: each.stamp_ns):
            writer.write(message)
        writer.close()


def stamped(message, stamp_ns, frame):
    message.header.stamp = ns_to_stamp(stamp_ns)
    message.header.frame_id = frame
    return message


def add_gnss(bag, rng, stamp_ns, row):
    x, y, z, yaw, speed, _ = row
    message = stamped(Gps(), stamp_ns, "utm")
    position, velocity = (
        message.localization.position,
        message.localization.linear_velocity,
    )
    place = np.array([x + EAST_M, y + NORTH_M, z + HEIGHT_M])
    noisy = np.round(place + rng.normal(0, 0.004, 3), 3)
    position.x, position.y, position.z = noisy
    moving = speed * np.array([math.cos(yaw), math.sin(yaw)])
    velocity.x, velocity.y = np.round(moving + rng.normal(0, 0.02, 2), 3)
    message.localization.heading = round(yaw, 4)
    bag.add("/gnss_driver/odometry", stamp_ns, message)


def add_wheels(bag, rng, stamp_ns, row):
    message = stamped(Odometry(child_frame_id="base_link"), stamp_ns, "wheels")
    message.pose.pose.orientation.w = 1.0
    twist = message.twist.twist
    twist.linear.x = round(1.02 * row[4] + rng.normal(0, 0.05), 3)  # worn tyres
    twist.angular.z = round(row[5] + rng.normal(0, 0.05), 3)
    message.twist.covariance[[0, 7, 35]] = 0.05**2, 0.02**2, 0.05**2
    bag.add("/wheels/odometry", stamp_ns, message)


def add_imu(bag, rng, stamp_ns, row):
    message = stamped(Imu(), stamp_ns, "imu")
    message.orientation_covariance[0] = -1.0  # no compass
    message.angular_velocity.z = round(row[5] + 0.004 + rng.normal(0, 0.01), 4)
    message.angular_velocity_covariance[8] = 0.01**2
    message.linear_acceleration.z = 9.81
    bag.add("/imu/data", stamp_ns, message)


def add_fix(bag, rng, stamp_ns, row):
    """The antenna is 0.6 m ahead of the axle."""
    z, yaw = row[2:4]
    ahead = 0.6 * np.array([math.cos(yaw), math.sin(yaw)])
    east, north = row[:2] + ahead + rng.normal(0, 0.5, 2)
    message = stamped(NavSatFix(), stamp_ns, "antenna")
    place = Geodesic.WGS84.Direct(
        LATITUDE_DEG,
        LONGITUDE_DEG,
        math.degrees(math.atan2(east, north)),
        math.hypot(east, north),
    )
    message.latitude = round(place["lat2"], 8)
    message.longitude = round(place["lon2"], 8)
    message.altitude = round(HEIGHT_M + z + rng.normal(0, 0.5), 2)
    message.position_covariance[[0, 4, 8]] = 0.25
    message.position_covariance_type = NavSatFix.COVARIANCE_TYPE_DIAGONAL_KNOWN
    bag.add("/gps/fix", stamp_ns, message)


def add_truth(bag, stamp_ns, row):
    message = stamped(Odometry(child_frame_id="base_link"), stamp_ns, "map")
    pose = message.pose.pose
    pose.position.x, pose.position.y = np.round(row[:2], 3)
    x, y, z, w = quaternion_from_yaw(row[3])
    pose.orientation = Quaternion(x=x, y=y, z=round(z, 4), w=round(w, 4))
    bag.add("/ground_truth", stamp_ns, message)


def add_frames(bag, stamp_ns):
    """Add the mounting poses of IMU and antenna."""
    transforms = []
    for frame, place in (("imu", (0.3, 0.0, 0.4)), ("antenna", (0.6, 0.0, 1.5))):
        transform = stamped(TransformStamped(child_frame_id=frame), 0, "base_link")
        transform.transform.translation = Vector3(x=place[0], y=place[1], z=place[2])
        transform.transform.rotation.w = 1.0
        transforms.append(transform)
    bag.add("/tf_static", stamp_ns, TFMessage(transforms=transforms))


def make(path, seed=7):
    rng = np.random.default_rng(seed)
    bag = Recording()
    add_frames(bag, START_NS)
    for tick, row in enumerate(drive()):
        stamp_ns = START_NS + tick * 10_000_000
        if tick % 10 == 0:
            add_gnss(bag, rng, stamp_ns, row)
        if tick % 10 == 3:
            add_wheels(bag, rng, stamp_ns, row)
        if tick % 5 == 1:
            add_imu(bag, rng, stamp_ns, row)
        if tick % 50 == 7:
            add_fix(bag, rng, stamp_ns, row)
        if tick % 20 == 0:
            add_truth(bag, stamp_ns, row)
    bag.write(Path(path))


if __name__ == "__main__":
    make(sys.argv[1])
