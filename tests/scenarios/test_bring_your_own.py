"""Methods, robots and nodes of the user, as the how-to prints them."""

import re
import textwrap
from pathlib import Path
from typing import Any

import pytest

from navette.errors import NavetteError
from navette.msgs.rcl_interfaces.msg import Log
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.simulation import Simulation
from navette.ros2.launch import show_arguments
from navette.ros2.launch.session import find_launch_file
from navette.ros2.names.node_classes import node_makers

PAGE = Path(__file__).parents[2] / "docs/howto/bring-your-own.md"
GOAL = ((-2.0, -2.0),)

OWN_NODE = """
import math

import rclpy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry, Path
from geometry_msgs.msg import PointStamped
from rclpy.node import Node


class StraightPlanner(Node):
    def __init__(self):
        super().__init__("straight_planner")
        self.pose = None
        self.paths = self.create_publisher(Path, "/path", 10)
        self.create_subscription(Odometry, "/odom/filtered", self.on_odometry, 10)
        self.create_subscription(PointStamped, "/goal_point", self.on_goal, 10)
        self.create_timer(0.5, self.plan)
        self.goal = None

    def on_odometry(self, msg):
        self.pose = msg.pose.pose.position

    def on_goal(self, msg):
        self.goal = msg.point
        self.plan()

    def plan(self):
        if self.pose is None or self.goal is None:
            return
        path = Path()
        path.header.frame_id = "map"
        yaw = math.atan2(self.goal.y - self.pose.y, self.goal.x - self.pose.x)
        for i in range(21):
            pose = PoseStamped()
            pose.pose.position.x = self.pose.x + (self.goal.x - self.pose.x) * i / 20
            pose.pose.position.y = self.pose.y + (self.goal.y - self.pose.y) * i / 20
            pose.pose.orientation.z = math.sin(yaw / 2)
            pose.pose.orientation.w = math.cos(yaw / 2)
            path.poses.append(pose)
        self.paths.publish(path)


def main():
    rclpy.init()
    rclpy.spin(StraightPlanner())
"""


@pytest.fixture
def files(tmp_path: Path) -> Path:
    """The files of the page, by the name that stands before each block."""
    text = PAGE.read_text(encoding="utf-8")
    found = re.findall(
        r"^`(my_\w+\.\w+)`[^\n]*\n\n```(?:python|yaml)\n(.*?)```", text, re.S | re.M
    )
    assert len(found) == 5
    for name, block in found:
        (tmp_path / name).write_text(block, encoding="utf-8")
    return tmp_path


def driven(**options: Any) -> tuple[Simulation, list[str]]:
    """Run to the goal; return the simulation and what was logged."""
    replaced = node_makers(options.pop("replacements", {}))
    defaults: dict[str, Any] = {
        "world": "arena",
        "robot": "jackal",
        "goals": GOAL,
        "headless": True,
        "speed": float("inf"),
        "max_time_s": 40.0,
    }
    simulation = Simulation(RunOptions(**(defaults | options)), replacements=replaced)
    texts: list[str] = []
    simulation.monitor.create_subscription(
        Log, "/rosout", lambda msg: texts.append(msg.msg), 100
    )
    try:
        simulation.run()
    finally:
        simulation.close()
    return simulation, texts


def result(simulation: Simulation) -> str:
    (outcome,) = simulation.summary().goals
    assert simulation.summary().contacts == 0
    return outcome.result


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "place"),
    [
        ("planner", "my_planner.py:plan"),
        ("controller", "my_controller.py:MyController"),
        ("controller", "my_controller.py"),
        ("costmap", "my_costmap.py:costmap"),
        ("mapping", "my_mapping.py:update"),
    ],
)
def test_a_method_of_the_page_drives(files: Path, kind: str, place: str) -> None:
    simulation, _ = driven(methods={kind: f"{files}/{place}"})
    assert result(simulation) == "reached"


@pytest.mark.slow
def test_a_robot_of_sizes_drives(files: Path) -> None:
    simulation, _ = driven(robot=str(files / "my_robot.yaml"))
    assert result(simulation) == "reached"
    assert simulation.stack.cruise_speed_mps == 0.8
    assert simulation.resolved.robot_name == "my_robot"


@pytest.mark.slow
def test_a_node_of_the_user_replaces_the_planner(tmp_path: Path) -> None:
    (tmp_path / "my_node.py").write_text(OWN_NODE, encoding="utf-8")
    place = str(tmp_path / "my_node.py")
    ends = []
    for _ in range(2):
        simulation, _ = driven(
            replacements={"planner": place}, world="empty", goals=((3.0, 1.0),)
        )
        assert result(simulation) == "reached"
        ends.append(simulation.summary().sim_time_s)
    assert ends[0] == ends[1]
    with pytest.raises(NavetteError, match="unknown node to replace 'wheels'; known"):
        driven(replacements={"wheels": place})


@pytest.mark.slow
def test_parameters_of_a_method_are_those_of_its_node(files: Path) -> None:
    place = f"{files}/my_controller.py:MyController"
    simulation, _ = driven(
        methods={"controller": place},
        parameters={"control": {"gain": 2.0}},
        max_time_s=0.5,
    )
    control = simulation.stack.control
    assert control.get_parameter("gain").value == 2.0
    with pytest.raises(NavetteError, match=r"'gain': -1\.0 is not allowed"):
        driven(methods={"controller": place}, parameters={"control": {"gain": -1.0}})
    with pytest.raises(NavetteError, match=r"no parameter 'gian'; did you mean 'gain'"):
        driven(methods={"controller": place}, parameters={"control": {"gian": 1.0}})


FAULTS = [
    ("planner", "def plan(grid, start, goal): return 1 / 0", "ZeroDivisionError"),
    ("planner", "def plan(grid, start, goal): return [1, 2, 3]", r"shape \(3,\)"),
    (
        "planner",
        "def plan(grid, start, goal): return [(0, 0), (float('nan'), 0)]",
        r"returned nan at index \(1, 0\)",
    ),
    (
        "planner",
        "def plan(grid, start, goal): return [(start.x, start.y), (9, 9)]",
        r"ends at \(9\.00, 9\.00\), .* m from the goal",
    ),
    (
        "controller",
        """
        def command(state, path, obstacles):
            if state.x < -1:
                raise ValueError("too far")
            return 0.5, 0.0
        """,
        "ValueError: too far",
    ),
    (
        "controller",
        "def command(state, path, obstacles): return None",
        "returned None; expected",
    ),
    (
        "controller",
        "def command(state, path, obstacles): return float('nan'), 0",
        "returned nan at index 0; expected .speed, turn rate.",
    ),
]


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "text", "match"), FAULTS)
def test_a_fault_is_logged_once_and_the_robot_stops(
    tmp_path: Path, kind: str, text: str, match: str
) -> None:
    (tmp_path / "mine.py").write_text(textwrap.dedent(text), encoding="utf-8")
    simulation, texts = driven(
        methods={kind: f"{tmp_path}/mine.py"}, goals=((-6.0, 0.0),), max_time_s=10.0
    )
    assert result(simulation) == "method_failed"
    (logged,) = [each for each in texts if re.search(match, each)]
    assert "mine.py" in logged
    assert abs(simulation.sim.simulator.motion().linear[0]) < 0.05


def test_the_launch_file_takes_methods_as_arguments() -> None:
    path, words = find_launch_file(["navette", "sim.launch.xml", "planner:=mine.py"])
    assert words == ["planner:=mine.py"]
    arguments = show_arguments(path)
    for name in ("planner", "controller", "costmap", "mapping", "robot", "world"):
        assert f"'{name}':" in arguments


@pytest.mark.slow
def test_without_a_costmap_the_robot_stops(tmp_path: Path) -> None:
    path = tmp_path / "mine.py"
    path.write_text("def costmap(scan, grid): return [[0]]\n", encoding="utf-8")
    simulation, texts = driven(methods={"costmap": f"{path}"}, max_time_s=5.0)
    assert len([each for each in texts if "shape (1, 1)" in each]) == 1
    assert simulation.monitor.progress.control in ("stale_costmap", "idle")
