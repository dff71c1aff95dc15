"""Each stage as a program: its robot's parameters, then its own; errors."""

import math
import re
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from navette.cli.up.config import DEFAULT_FILE
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from navette.msgs.geometry_msgs.msg import PointStamped
from navette.navigation.stack import RunOptions, stages
from navette.navigation.stack.localization import LOCALIZATION_NODES
from navette.navigation.stack.scene import resolve_scene
from navette.navigation.stack.simulation import Simulation
from navette.navigation.stack.stage_classes import node_classes
from navette.ros2.launch.session import find_launch_file
from navette.ros2.names.process import RunningProgram, program_threads
from navette.ros2.names.targets import read_programs
from navette.ros2.workspace import find_package
from navette.runtime import (
    Context,
    DurabilityPolicy,
    Future,
    Node,
    QoSProfile,
    spin_until_future_complete,
)
from navette.runtime.context import new_graph
from navette.runtime.graph import Graph
from navette.runtime.overrides import ParameterOverrides
from navette.runtime.parameter import parameter_value_to_python
from navette.runtime.parameter_client import AsyncParameterClient

WAIT_S = 20.0


@contextmanager
def running(graph: Graph, *words: str) -> Iterator[None]:
    """A program in a thread, until the block ends."""
    seen = threading.Event()
    forget = graph.on_change(lambda: seen.set() if graph.nodes() else None)
    (program,) = read_programs(words)
    with program_threads():
        thread = RunningProgram(program, graph)
        thread.start()
        try:
            assert seen.wait(WAIT_S), f"{words}: no node came"
            yield
        finally:
            forget()
            thread.shut_down()
            assert thread.join(WAIT_S)


def parameters(graph: Graph, node: str, *names: str) -> list[object]:
    context = Context(graph=graph)
    with context:
        asking = Node("asking", context=context)
        client = AsyncParameterClient(asking, node)
        assert client.wait_for_services(WAIT_S)
        future = client.get_parameters(list(names))
        spin_until_future_complete(asking, future, timeout_sec=WAIT_S)
        return [parameter_value_to_python(v) for v in future.result().values]


@pytest.mark.slow
def test_a_stage_uses_its_robots_parameters_then_its_own() -> None:
    graph = new_graph()
    words = "control --robot husky --ros-args -r __node:=steer -p cruise_speed_mps:=0.3"
    with running(graph, *words.split()):
        cruise, fastest = parameters(
            graph, "/steer", "cruise_speed_mps", "max_speed_mps"
        )
    assert (cruise, fastest) == (0.3, 1.0)
    graph.close()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("source", "nodes"),
    [
        ("truth", {"/localizer"}),
        ("odometry+imu", {"/ekf", "/localizer"}),
        ("slam+wheels", {"/slam"}),
        ("amcl", {"/ekf", "/amcl"}),
    ],
)
def test_the_localization_is_that_of_the_switch(source: str, nodes: set[str]) -> None:
    graph = new_graph()
    words = f"localization --world arena --localization {source}"
    with running(graph, *words.split()):
        arrived = threading.Event()

        def look() -> None:
            if {node.full_name for node in graph.nodes()} == nodes:
                arrived.set()

        forget = graph.on_change(look)
        look()
        assert arrived.wait(WAIT_S), [node.full_name for node in graph.nodes()]
        forget()
    graph.close()


@pytest.mark.slow
def test_the_localization_starts_where_the_simulated_robot_does() -> None:
    options = RunOptions(world="arena", headless=True)
    simulation = Simulation(options)
    start = simulation.sim.simulator.pose().to_pose2()
    simulation.close()
    graph = new_graph()
    words = "localization --world arena --localization amcl"
    with running(graph, *words.split()):
        names = (f"initial_pose.{each}" for each in ("x", "y", "yaw"))
        is_given, x, y, yaw = parameters(graph, "/amcl", "set_initial_pose", *names)
        initial = parameters(graph, "/ekf", "initial_state")
    assert is_given
    assert (x, y, yaw) == pytest.approx(tuple(start), abs=1e-3)
    assert initial[0][:2] == pytest.approx((start.x, start.y), abs=1e-3)
    graph.close()


@pytest.mark.slow
def test_a_localization_alone_has_no_start() -> None:
    """The robot may be real: amcl searches the map."""
    graph = new_graph()
    with running(graph, "amcl"):
        assert parameters(graph, "/amcl", "set_initial_pose") == [False]
    with running(graph, *"amcl --start 1 2 90 --ros-args -r __node:=here".split()):
        names = (f"initial_pose.{each}" for each in ("x", "y", "yaw"))
        assert parameters(graph, "/here", *names) == pytest.approx([1, 2, math.pi / 2])
    graph.close()


def test_services_and_launch_file_start_the_nodes_of_a_run() -> None:
    """``navette up``, ``sim.launch.xml`` and ``navette sim`` have the same nodes."""
    of_run = {"localization", "viewer"} | {name for name, _ in node_classes()}
    of_run -= {
        *LOCALIZATION_NODES,
        "odom_integrator",
        "explorer",
        "lifecycle_manager_navigation",
    }
    services = DEFAULT_FILE.read_text(encoding="utf-8")
    started = set(re.findall(r"navette (\w+) --world", services))
    assert started == of_run
    path, _ = find_launch_file(["navette", "sim.launch.xml"])
    launched = re.findall(r'exec="(\w+)"', path.read_text(encoding="utf-8"))
    assert set(launched) == of_run | {"lifecycle_manager"}


@pytest.mark.slow
def test_the_odom_integrator_uses_its_configuration_under_any_name() -> None:
    graph = new_graph()
    words = "odom_integrator --ros-args -r __node:=trip -p odom_type:=vel"
    with running(graph, *words.split()):
        values = parameters(graph, "/trip", "odom_type", "topic")
    assert values == ["vel", "/gnss_driver/odometry"]
    graph.close()


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ("planner --robot husk", "unknown robot .* 'husk'; known: course, husky"),
        ("planner --ros-args -p clearence:=1", "unknown parameter 'clearence'"),
        ("costmap --ros-args -p use_sim_time:=3", "is INTEGER, expected BOOL"),
        ("sim --speed 0", "real-time factor must be"),
        ("odom_integrator --ros-args -p odom_type:=speed", "one of pos, gps, vel"),
        ("ekf", "set the topic of at least one of odom0"),
        ("missions --goal 1 nan", "'goals_m': nan is not allowed"),
    ],
)
def test_errors_are_reported_in_one_line(
    monkeypatch: pytest.MonkeyPatch, words: str, reason: str
) -> None:
    name, *arguments = words.split()
    monkeypatch.setattr(sys, "argv", [name, *arguments])
    with pytest.raises(SystemExit, match=f"navette: .*{reason}"):
        getattr(stages, name)()


def test_a_file_of_the_whole_stack_is_valid_but_one_for_other_nodes_is_not(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    file = tmp_path / "stack.yaml"
    file.write_text("planer:\n  ros__parameters:\n    method: dijkstra\n")
    argv = ["planner", "--ros-args", "--params-file", str(file)]
    monkeypatch.setattr(sys, "argv", argv)
    with pytest.raises(SystemExit, match="no node matches '/planer'; nodes: /planner"):
        stages.planner()
    made = []
    monkeypatch.setattr(
        stages.runtime, "spin", lambda node: made.append(node.params.method)
    )
    file.write_text(
        file.read_text() + "planner:\n  ros__parameters:\n    method: dijkstra\n"
    )
    stages.planner()
    assert made == ["dijkstra"]


@pytest.mark.slow
@pytest.mark.parametrize(("results", "code"), [("reached", 0), ("no_path", 1)])
def test_a_mission_ends_with_its_goals(results: str, code: int) -> None:
    """A planner that reports the result of each goal at once."""
    graph = new_graph()
    words = "missions --goal 1 2 --goal 3 4 --ros-args -p wait_for_map:=false"
    (program,) = read_programs(words.split())
    goals = []
    with Context(graph=graph) as context, program_threads():
        planner = Node("planner", context=context)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        status = planner.create_publisher(DiagnosticStatus, "/planner/status", latched)

        def answer(goal: PointStamped) -> None:
            goals.append((goal.point.x, goal.point.y))
            number = KeyValue(key="goal_id", value=str(len(goals)))
            status.publish(DiagnosticStatus(message=results, values=[number]))

        planner.create_subscription(PointStamped, "/goal_point", answer, 10)
        status.publish(DiagnosticStatus(message="idle"))
        over = Future[None]()
        mission = RunningProgram(
            program,
            graph,
            on_end=lambda _: context.loop.call_soon_threadsafe(
                lambda: over.set_result(None), "test"
            ),
        )
        mission.start()
        spin_until_future_complete(planner, over, timeout_sec=WAIT_S)
        assert mission.join(WAIT_S)
    assert mission.exit_code == code
    assert goals == [(1.0, 2.0), (3.0, 4.0)]
    graph.close()


def test_every_stage_is_an_executable() -> None:
    names = [each.name for each in find_package("navette").executables()]
    assert {"sim", "costmap", "map_memory", "planner", "control", "arbiter"} <= set(
        names
    )
    for name in names:
        assert read_programs([name])[0].name == name
        assert read_programs(["navette", name, "--x"])[0].arguments == ("--x",)


def test_the_live_view_has_the_robots_frames(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seen = []

    def run(make: object, profile: ParameterOverrides, **options: object) -> None:
        values = profile.for_node("/viewer")
        seen.append({name: override.value for name, override in values.items()})

    monkeypatch.setattr(stages, "_run", run)
    for words in ("", "--robot course", "--robot husky"):
        monkeypatch.setattr(sys, "argv", ["viewer", *words.split()])
        stages.viewer()
    assert seen == [{}, {"map_frame": "sim_world", "base_frame": "robot"}, {}]


@pytest.mark.parametrize("robot", ["course", "husky", "jackal", "turtlebot3_burger"])
def test_a_stage_has_the_same_parameters_as_in_one_process(robot: str) -> None:
    resolved = resolve_scene(RunOptions(robot=robot))
    together = ParameterOverrides()
    resolved.override_parameters(together)
    for name in ("sim", "costmap", "map_memory", "planner", "control", "arbiter"):
        alone = stages._profile(resolved, name).for_node("/any/name")
        expected = together.for_node(f"/{name}")
        assert {k: v.value for k, v in alone.items()} == {
            k: v.value for k, v in expected.items()
        }
