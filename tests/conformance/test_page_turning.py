"""The page draws a scan where the robot was at its stamp, while the robot turns."""

import math
import shutil
import sys
from collections import deque
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from test_viewer_javascript import run_node

from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.geometry_msgs.msg import TransformStamped
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.msgs.std_msgs.msg import Header
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.runtime import Context, Node
from navette.runtime.tf import StaticTransformBroadcaster

sys.path.append(str(Path(__file__).parents[1] / "unit" / "viewer"))

from viewer_harness import Program

pytestmark = pytest.mark.long

HALF_LENGTH_M, HALF_WIDTH_M = 3.0, 2.0
TURN_RATE = 1.5  # rad/s
X_M, Y_M, MAP_YAW = 0.5, -0.3, 0.4  # of the odometry's frame in the map
RAYS = 180
PERIOD_S = 0.02
SCAN_EVERY, SCAN_LATE, MAP_LATE = 5, 2, 4  # periods


def distances(yaw: float) -> np.ndarray:
    """Return (RAYS,) distances to the room's walls from the odometry's origin."""
    bearings = np.linspace(-math.pi, math.pi, RAYS, endpoint=False) + MAP_YAW + yaw
    c, s = np.cos(bearings), np.sin(bearings)
    with np.errstate(divide="ignore"):
        along_x = (np.copysign(HALF_LENGTH_M, c) - X_M) / c
        along_y = (np.copysign(HALF_WIDTH_M, s) - Y_M) / s
    return np.minimum(along_x, along_y)


def transform(parent: str, child: str, stamp: Time, yaw: float) -> TransformStamped:
    made = TransformStamped(header=Header(frame_id=parent, stamp=stamp))
    made.child_frame_id = child
    made.transform.rotation.z = math.sin(yaw / 2)
    made.transform.rotation.w = math.cos(yaw / 2)
    return made


class TurningRobot(Node):
    """Turns at a constant rate; scans and corrections arrive after the odometry."""

    def __init__(self, context: Context) -> None:
        super().__init__("robot", context=context)
        self._ticks = 0
        self._first_ns: int | None = None
        self._queue: deque[tuple[int, Callable[[], None]]] = deque()
        self._tf = self.create_publisher(TFMessage, "/tf", 100)
        self._scan = self.create_publisher(LaserScan, "/lidar", 10)
        self._odometry = self.create_publisher(Odometry, "/odom", 10)
        self._static = StaticTransformBroadcaster(self)
        self._static.sendTransform(transform("base_link", "lidar", Time(), 0.0))
        self.create_timer(PERIOD_S, self._on_timer)

    def _on_timer(self) -> None:
        now = self.get_clock().now()
        if self._first_ns is None:
            self._first_ns = now.nanoseconds
        yaw = TURN_RATE * (now.nanoseconds - self._first_ns) / 1e9
        stamp = now.to_msg()
        moved = transform("odom", "base_link", stamp, yaw)
        self._tf.publish(TFMessage(transforms=[moved]))
        odometry = Odometry(header=moved.header, child_frame_id="base_link")
        odometry.pose.pose.orientation = moved.transform.rotation
        self._odometry.publish(odometry)
        if self._ticks % SCAN_EVERY == 0:
            self._measure(stamp, yaw)
        while self._queue and self._queue[0][0] <= self._ticks:
            _, publish = self._queue.popleft()
            publish()
        self._ticks += 1

    def _measure(self, stamp: Time, yaw: float) -> None:
        scan = LaserScan(header=Header(frame_id="lidar", stamp=stamp))
        scan.angle_min, scan.angle_increment = -math.pi, math.tau / RAYS
        scan.range_min, scan.range_max = 0.1, 20.0
        scan.ranges = distances(yaw).astype(np.float32)
        corrected = transform("map", "odom", stamp, MAP_YAW)
        corrected.transform.translation.x = X_M
        corrected.transform.translation.y = Y_M
        late = TFMessage(transforms=[corrected])
        due = self._ticks + SCAN_LATE
        self._queue.append((due, partial(self._scan.publish, scan)))
        due = self._ticks + MAP_LATE
        self._queue.append((due, partial(self._tf.publish, late)))


@pytest.mark.slow
def test_the_scan_lies_on_the_walls_while_the_robot_turns() -> None:
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        pytest.skip("Chromium is not installed")
    room = (str(HALF_LENGTH_M), str(HALF_WIDTH_M))
    with Program(TurningRobot) as program:
        seen = run_node("turning.mjs", program.viewer.url, chromium, *room)
    assert seen["problems"] == []
    # A pixel is 1 to 2 cm, a point 3 pixels; at the newest transform 58 cm.
    assert max(seen["distances"]) < 0.05
