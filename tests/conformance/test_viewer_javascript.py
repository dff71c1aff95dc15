"""The live view with published JavaScript: client, codec and a browser."""

import json
import shutil
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.geometry_msgs.msg import PointStamped, Twist
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.msgs.rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from navette.msgs.sensor_msgs.msg import Image, LaserScan
from navette.msgs.std_msgs.msg import Header, String
from navette.runtime import Context, Node
from navette.runtime.qos import QoSDurabilityPolicy, QoSProfile

JAVASCRIPT = Path(__file__).parent / "js"
sys.path.append(str(Path(__file__).parents[1] / "unit" / "viewer"))

from viewer_harness import Program  # noqa: E402 - from the unit tests' folder

pytestmark = pytest.mark.long

LATCHED = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
TREE = """{o} Drive [*]
    --> Follow [*] -- 3 m
    --> Wait [-]"""
RANGES = [1.5, float("inf"), 2.25]


class Robot(Node):
    """Publishes one message of each type that the scripts read; records goals."""

    def __init__(self, context: Context) -> None:
        super().__init__("robot", context=context)
        bounds = FloatingPointRange(from_value=0.5, to_value=2.0)
        text = ParameterDescriptor(floating_point_range=[bounds])
        self.declare_parameter("speed_mps", 1.0, text)
        self.goal = threading.Event()
        self.goals: list[PointStamped] = []
        self.chatter = self.create_publisher(String, "/chatter", 10)
        self.lidar = self.create_publisher(LaserScan, "/lidar", 10)
        self.odometry = self.create_publisher(Odometry, "/odom/filtered", 10)
        self.create_publisher(Image, "/camera", 10)
        self.create_subscription(PointStamped, "/goal_point", self.on_goal, 10)
        self.speeds: list[tuple[float, float]] = []
        self.stands = threading.Event()
        self.create_subscription(Twist, "/cmd_vel", self.on_speed, 10)
        grid = OccupancyGrid(header=Header(frame_id="map"))
        grid.info.width, grid.info.height, grid.info.resolution = 3, 1, 2.0
        grid.data = np.array([0, 100, -1], np.int8)
        self.create_publisher(OccupancyGrid, "/map", LATCHED).publish(grid)
        status = DiagnosticStatus(name="planner", message="waiting_for_goal")
        self.create_publisher(DiagnosticStatus, "/planner/status", LATCHED).publish(
            status
        )
        tree = self.create_publisher(String, "/behavior_tree", LATCHED)
        tree.publish(String(data=TREE))
        self.create_publisher(String, "/drive/_action/status", 10)
        self.create_timer(0.02, self.on_timer)

    def on_timer(self) -> None:
        self.chatter.publish(String(data="grüezi"))
        self.lidar.publish(LaserScan(ranges=RANGES))
        odometry = Odometry(header=Header(frame_id="map"), child_frame_id="base_link")
        odometry.pose.pose.position.x = -6.25
        self.odometry.publish(odometry)

    def on_goal(self, goal: PointStamped) -> None:
        self.goals.append(goal)
        self.goal.set()

    def on_speed(self, speed: Twist) -> None:
        self.speeds.append((speed.linear.x, speed.angular.z))
        if self.speeds[-1] == (0.0, 0.0):
            self.stands.set()


@pytest.fixture
def program() -> Iterator[Program]:
    with Program(Robot) as running:
        yield running


def run_node(script: str, *arguments: str) -> Any:
    """Run a script and return its output; skip without Node.js or its packages."""
    node = shutil.which("node")
    if node is None:
        pytest.skip("Node.js is not installed")
    if not (JAVASCRIPT / "node_modules").is_dir():
        pytest.skip("npm packages are missing: npm ci --prefix tests/conformance/js")
    done = subprocess.run(
        [node, str(JAVASCRIPT / script), *arguments],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def robot_of(program: Program) -> Robot:
    node = program.nodes[0]
    assert isinstance(node, Robot)
    return node


def assert_goal_arrived(program: Program) -> None:
    robot = robot_of(program)
    assert robot.goal.wait(60.0)
    goal = robot.goals[0]
    assert (goal.point.x, goal.point.y, goal.header.frame_id) == (6.0, -12.5, "map")


@pytest.mark.slow
def test_the_published_client_and_codec_understand_it(program: Program) -> None:
    seen = run_node("client.mjs", f"ws://{program.address}")
    assert seen["errors"] == []
    assert seen["info"]["metadata"] == {"ROS_DISTRO": "jazzy"}
    assert seen["messages"]["/chatter"]["value"] == {"data": "grüezi"}
    assert seen["messages"]["/map"]["value"]["data"] == [0, 100, -1]
    # JSON writes infinity as null.
    assert seen["messages"]["/lidar"]["value"]["ranges"] == [1.5, None, 2.25]
    assert int(seen["messages"]["/lidar"]["stamp"]) > 10**18
    assert seen["topics"]["/lidar"] == "sensor_msgs/msg/LaserScan"
    assert seen["parameters"]["/robot.speed_mps"] == 1
    assert {"name": "/chatter", "publisherIds": ["/robot"]} in seen["graph"][
        "publishedTopics"
    ]
    assert_goal_arrived(program)


@pytest.mark.slow
def test_the_page_works_in_a_browser(program: Program) -> None:
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        pytest.skip("Chromium is not installed")
    seen = run_node("page.mjs", program.viewer.url, chromium)
    assert seen["problems"] == []
    assert seen["title"] == "Navette"
    assert seen["address"] == seen["foxglove"] == f"ws://{program.address}"
    assert seen["position"] == "−6.25, 0.00 m"
    rows = {row[0]: row for row in seen["rows"]}
    assert rows["/chatter"][1:3] == [
        "String",
        "Publishers: /robot\nSubscribers: none",
    ]
    assert float(rows["/chatter"][3].split()[0]) > 5.0
    # A camera is subscribed on request only.
    assert seen["onRequest"] == 1
    assert seen["tree"] == [
        ["tree-running", "●Drivefallback"],
        ["tree-running", "●Follow3 m"],
        ["tree-idle", "○Wait"],
    ]
    assert sorted(rows) == sorted(
        name for name in seen["topics"] if "/_action/" not in name
    )
    assert len(rows) < len(seen["topics"])
    assert "/robot" in seen["nodes"]
    assert seen["slider"] == ["0.5", "2"]
    assert "9.0" in seen["refusal"]
    assert_goal_arrived(program)
    assert seen["layers"] == ["/map", "/lidar", "/odom/filtered"]
    clicked = robot_of(program).goals[1].point
    assert [clicked.x, clicked.y] == pytest.approx(seen["place"], abs=0.05)
    assert robot_of(program).stands.wait(60.0)
    speeds = robot_of(program).speeds
    assert (0.5, 0.8) in speeds
    assert speeds[-1] == (0.0, 0.0)
    assert robot_of(program).get_parameter("speed_mps").value == 1.5
