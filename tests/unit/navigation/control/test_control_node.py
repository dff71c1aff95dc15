"""The control node in a graph, with a simulated robot around it."""

import math
from collections.abc import Iterator

import numpy as np
import pytest
from control_graph import World
from control_plant import tangent_path

from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from navette.msgs.geometry_msgs.msg import Twist
from navette.runtime import Parameter
from navette.runtime.testing import GraphHarness

STRAIGHT = tangent_path(np.array([[0, 0], [3, 0.0]]))


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness() as harness:
        yield harness


@pytest.fixture
def world(graph: GraphHarness) -> World:
    made = World(graph)
    graph.run_for(1.0)
    return made


def test_before_a_path_only_the_state_is_published(world: World) -> None:
    assert world.commands.count == 0
    assert world.state == "idle"


def test_at_the_end_of_the_path_zeros_are_published_then_nothing(world: World) -> None:
    world.send_path(STRAIGHT)
    assert world.graph.run_until(lambda: world.state == "reached", 15.0)
    assert math.dist((world.plant.pose.x, world.plant.pose.y), (3.0, 0.0)) < 0.1
    assert world.states == ["idle", "following", "reached"]
    world.graph.run_for(1.0)
    last = [(m.linear.x, m.angular.z) for m in world.commands.messages[-5:]]
    assert last == [(0.0, 0.0)] * 5
    count = world.commands.count
    world.graph.run_for(2.0)
    assert world.commands.count == count


def test_commands_are_published_at_the_rate(world: World) -> None:
    world.send_path(STRAIGHT)
    world.graph.run_for(2.0)
    assert np.diff(world.commands.stamps_ns).tolist() == [50_000_000] * 39


def test_the_state_is_repeated_with_figures(world: World) -> None:
    world.send_path(STRAIGHT)
    world.graph.run_for(3.0)
    details = {pair.key: pair.value for pair in world.status.last.values}
    assert 0.2 < float(details["speed_mps"]) <= 0.5
    assert 1.0 < float(details["distance_left_m"]) < 2.5
    assert details["limited_by"] == ""
    assert len(world.status.messages) >= 6


@pytest.mark.parametrize(
    ("lost", "state"), [("lidar", "stale_costmap"), ("odometry", "stale_odometry")]
)
def test_the_robot_stops_within_half_a_second_of_a_lost_input(
    world: World, lost: str, state: str
) -> None:
    world.send_path(STRAIGHT)
    world.graph.run_for(3.0)
    assert world.plant.speed > 0.4
    setattr(world, lost, False)
    world.graph.run_for(0.36)
    assert (world.commands.last.linear.x, world.state) == (0.0, state)
    world.graph.run_for(0.6)
    assert world.plant.speed < 0.01
    setattr(world, lost, True)
    assert world.graph.run_until(lambda: world.state == "reached", 15.0)


def test_a_missing_planner_stops_the_robot(world: World) -> None:
    world.send_path(tangent_path(np.array([[0, 0], [9, 0.0]])))
    world.planner = False
    world.graph.run_for(1.9)
    assert world.state == "following"
    world.graph.run_for(0.7)
    assert world.state == "stale_path"
    assert world.commands.last == Twist()


def test_a_restarted_planner_drops_the_path(world: World) -> None:
    world.send_path(tangent_path(np.array([[0, 0], [9, 0.0]])))
    world.graph.run_for(2.0)
    world.planner = False
    world.graph.run_for(3.0)
    assert world.state == "stale_path"
    world.planner, world.planner_publishes = True, "waiting_for_goal"
    world.graph.run_for(2.0)
    assert (world.state, world.plant.speed) == ("idle", pytest.approx(0.0, abs=0.01))


def test_a_path_of_another_node_is_followed_beside_an_idle_planner(
    graph: GraphHarness,
) -> None:
    world = World(graph)
    world.planner_publishes = "waiting_for_goal"
    graph.run_for(1.0)
    world.send_path(STRAIGHT)
    assert graph.run_until(lambda: world.state == "reached", 15.0)


def test_a_path_from_a_user_without_planner_can_be_followed(
    graph: GraphHarness,
) -> None:
    world = World(graph, planner_timeout_s=0.0)
    world.planner = False
    graph.run_for(1.0)
    world.send_path(STRAIGHT)
    assert graph.run_until(lambda: world.state == "reached", 15.0)


def test_a_costmap_in_the_robots_frame_is_placed_on_the_map(world: World) -> None:
    world.wall_x = 2.5
    world.send_path(STRAIGHT)
    assert world.graph.run_until(lambda: world.state == "blocked", 15.0)
    world.graph.run_for(1.0)
    # The body ends 0.25 m ahead of the axle; the wall's cells are 0.1 m.
    assert 2.0 < world.plant.pose.x < 2.22
    assert world.status.last.level == b"\x01"
    world.wall_x = None
    assert world.graph.run_until(lambda: world.state == "reached", 15.0)


@pytest.mark.parametrize("resolution", [0.0, math.nan, -0.1, 1e30])
def test_invalid_costmaps_stop_the_robot_as_missing_ones(
    world: World, resolution: float
) -> None:
    world.send_path(STRAIGHT)
    world.graph.run_for(3.0)
    world.resolution = resolution
    world.graph.run_for(0.36)
    assert (world.commands.last.linear.x, world.state) == (0.0, "stale_costmap")
    world.resolution = 0.1
    assert world.graph.run_until(lambda: world.state == "reached", 15.0)


def test_an_empty_path_stops(world: World) -> None:
    world.send_path(STRAIGHT)
    world.graph.run_for(2.0)
    world.send_path(np.empty((0, 3)))
    world.graph.run_for(0.1)
    assert world.commands.last == Twist()
    assert world.state == "idle"


@pytest.mark.parametrize(
    ("poses", "frame", "state"),
    [
        (STRAIGHT, "odom", "unknown_frame"),
        (np.array([[0, 0, 0], [math.nan, 0, 0]]), "map", "invalid_path"),
    ],
)
def test_a_path_that_cannot_be_followed_stops_with_a_reason(
    world: World, poses: np.ndarray, frame: str, state: str
) -> None:
    world.send_path(STRAIGHT)
    world.graph.run_for(2.0)
    world.send_path(poses, frame)
    world.graph.run_for(0.2)
    assert (world.commands.last, world.state) == (Twist(), state)
    world.send_path(STRAIGHT)
    assert world.graph.run_until(lambda: world.state == "reached", 15.0)


def test_destroying_the_node_stops_the_robot(world: World) -> None:
    world.send_path(STRAIGHT)
    world.graph.run_for(2.0)
    assert world.commands.last.linear.x > 0.4
    world.node.destroy_node()
    world.graph.run_for(0.1)
    assert world.commands.last == Twist()


def test_parameters_can_change_while_driving(world: World) -> None:
    world.send_path(STRAIGHT)
    world.graph.run_for(2.0)
    [result] = world.node.set_parameters([Parameter("cruise_speed_mps", value=0.2)])
    assert result.successful
    world.graph.run_for(1.5)
    assert world.plant.speed == pytest.approx(0.2, abs=0.01)
    [result] = world.node.set_parameters([Parameter("footprint_m", value=[1.0, 2.0])])
    assert not result.successful
    world.node.set_parameters([Parameter("method", value="cross_track_pid")])
    world.node.set_parameters([Parameter("rate_hz", value=10.0)])
    assert world.graph.run_until(lambda: world.state == "reached", 20.0)


def test_the_same_run_twice_gives_the_same_commands() -> None:
    runs = []
    for _ in range(2):
        with GraphHarness() as graph:
            world = World(graph)
            world.send_path(tangent_path(np.array([[0, 0], [1, 0], [2, 0.5]])))
            graph.run_for(6.0)
            runs.append([(m.linear.x, m.angular.z) for m in world.commands.messages])
    assert runs[0] == runs[1]
    assert runs[0]


def test_the_path_is_kept_while_another_source_commands(world: World) -> None:
    def commander(name: str, masked: str) -> None:
        values = [KeyValue(key="masked_topics", value=masked)]
        status = DiagnosticStatus(message=name, values=values)
        world.graph.publish("/commander", status, latched=True)
        world.graph.run_for(1e-9)

    world.send_path(STRAIGHT)
    world.graph.run_for(3.0)
    commander("operator", "/cmd_vel,/cmd_vel_nav")
    assert world.state == "paused"
    count = world.commands.count
    world._command = Twist()  # the operator holds the robot
    world.graph.run_for(20.0)
    assert world.commands.count == count
    commander("idle", "")
    assert world.state == "following"
    assert world.commands.last.linear.x < 0.2, "accelerates from rest"
    assert world.graph.run_until(lambda: world.state == "reached", 15.0)
    commander("operator", "/cmd_vel_nav")
    world.graph.run_for(1.0)
    assert world.state == "reached", "nothing to pause"


def test_rollouts_are_published_while_subscribed_to(graph: GraphHarness) -> None:
    world = World(graph, method="mppi")
    path = tangent_path(np.array([[0, 0], [6, 0.0]]))
    graph.run_for(1.0)
    world.send_path(path)
    graph.run_for(1.0)
    shown = graph.collect("/trajectories", "visualization_msgs/msg/MarkerArray")
    graph.run_for(2.0)
    assert 8 <= len(shown.messages) <= 12, "five a second"
    first, *lines = shown.last.markers
    assert first.action == first.DELETEALL
    assert len(lines) == 48
    assert all(len(line.points) > 5 for line in lines)
    world.send_path(np.empty((0, 3)))
    graph.run_for(1.0)
    assert len(shown.last.markers) == 1, "the lines are removed"
