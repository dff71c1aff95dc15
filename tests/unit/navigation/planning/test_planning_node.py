"""The planner node in a graph: what it publishes, when."""

import math
from collections.abc import Iterator

import numpy as np
import pytest
from planner_graph import World
from planning_worlds import fill

from navette.geometry import Pose2
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.geometry_msgs.msg import PoseStamped, TransformStamped
from navette.msgs.std_msgs.msg import Empty
from navette.msgs.std_srvs.srv import Trigger
from navette.navigation.grids import CellWindow, shared_cells
from navette.navigation.planning import NewMap
from navette.navigation.planning.planner import Planner
from navette.runtime import Parameter, StaticTransformBroadcaster
from navette.runtime.testing import GraphHarness


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness() as harness:
        yield harness


def test_a_goal_becomes_a_path_in_the_map_frame(graph: GraphHarness) -> None:
    world = World(graph).ready()
    assert world.message == "waiting_for_goal"
    assert world.paths.count == 0
    world.send(8.03, 4.02)
    graph.run_for(0.01)
    assert world.message == "following"
    path = world.paths.last
    assert path.header.frame_id == "map"
    assert all(p.pose.position.z == 0 for p in path.poses)
    poses = world.last_path()
    np.testing.assert_allclose(poses[0, :2], (1, 4))
    np.testing.assert_allclose(poses[-1, :2], (8.03, 4.02))
    assert np.hypot(*np.diff(poses[:, :2], axis=0).T).max() <= 0.1 + 1e-9
    values = world.values
    assert (values["goal_id"], values["result"], values["plan"]) == ("1", "", "ok")
    assert float(values["goal_x"]) == pytest.approx(8.03)
    assert float(values["distance_left_m"]) == pytest.approx(7.03, abs=0.01)
    assert values["phase"] == "waiting_for_robot_to_reach_goal"
    assert values["retry"] == "0"


def test_an_unchanged_world_publishes_one_path(graph: GraphHarness) -> None:
    world = World(graph).ready()
    world.send(8, 4)
    for _ in range(4):
        graph.run_for(1.0)
        world.send_map()
    assert world.paths.count == 1


def test_arrival_is_detected_with_the_next_odometry(graph: GraphHarness) -> None:
    world = World(graph).ready()
    world.send(8, 4)
    graph.run_for(0.5)
    for x in np.arange(1.0, 8.0, 0.2):
        world.pose = Pose2(float(x), 4, 0)
        graph.run_for(0.1)
    world.pose = Pose2(7.95, 4, 0)
    graph.run_for(0.15)
    assert world.message == "reached"
    assert world.values["result"] == "reached"
    assert not len(world.paths.last.poses)


def test_goals_before_the_map_or_the_odometry_wait(graph: GraphHarness) -> None:
    world = World(graph)
    world.odometry = False
    world.send(8, 4)
    graph.run_for(0.1)
    assert world.message == "waiting_for_odometry"
    world.odometry = True
    graph.run_for(0.6)
    assert world.message == "waiting_for_map"
    world.send_map()
    graph.run_for(0.01)
    assert world.message == "following"


@pytest.mark.parametrize(
    ("x", "y", "frame", "result"),
    [
        (math.nan, 4.0, "map", "goal_not_finite"),
        (8.0, math.inf, "map", "goal_not_finite"),
        (800.0, 4.0, "map", "goal_outside_map"),
        (8.0, 4.0, "mars", "unknown_frame"),
        (5.0, 4.0, "map", "goal_blocked"),
        (9.5, 7.5, "map", "no_path"),
    ],
)
def test_bad_goals_have_named_results_within_a_second(
    graph: GraphHarness, x: float, y: float, frame: str, result: str
) -> None:
    world = World(graph)
    fill(world.occupancy, world.spec, (4, 6), (3, 5))
    fill(world.occupancy, world.spec, (8.6, 8.8), (6.4, 8))
    fill(world.occupancy, world.spec, (8.6, 10), (6.4, 6.6))
    world.ready()
    world.send(2.5, 4)
    graph.run_for(0.5)
    assert world.message == "following"
    world.send(x, y, frame)
    graph.run_for(1.0)
    assert world.message == result
    assert world.reports.last.level == b"\x02"
    assert (world.values["result"], world.values["goal_id"]) == (result, "2")
    assert not len(world.paths.last.poses), "the robot is stopped"
    world.send(2.5, 4)
    graph.run_for(0.1)
    assert world.message == "following", "alive"


@pytest.mark.parametrize("topic", ["/goal_pose", "/planner/goal_pose"])
@pytest.mark.parametrize(
    ("w", "nanosec", "result"),
    [
        (5.0, 0, "goal_orientation_invalid"),
        (math.nan, 0, "goal_not_finite"),
        (1.0, 2_000_000_000, "goal_stamp_invalid"),
    ],
)
def test_a_malformed_goal_is_refused_with_the_true_reason(
    graph: GraphHarness, topic: str, w: float, nanosec: int, result: str
) -> None:
    world = World(graph).ready()
    goal = PoseStamped()
    goal.header.frame_id, goal.header.stamp.nanosec = "map", nanosec
    goal.pose.position.x, goal.pose.position.y = 2.5, 4.0
    goal.pose.orientation.w = w
    graph.publish(topic, goal)
    graph.run_for(1.0)
    assert (world.message, world.values["result"]) == (result, result)


def test_a_goal_without_a_frame_is_in_the_map_frame(graph: GraphHarness) -> None:
    world = World(graph).ready()
    world.send(3, 4, frame="")
    graph.run_for(0.1)
    assert world.message == "following"
    np.testing.assert_allclose(world.last_path()[-1, :2], (3, 4))


def test_goals_in_frames_of_the_robot_are_placed_by_its_pose(
    graph: GraphHarness,
) -> None:
    world = World(graph)
    world.pose = Pose2(2, 2, math.pi / 2)
    mount = TransformStamped(child_frame_id="mast")
    mount.header.frame_id = "base_link"
    mount.transform.translation.x = 0.5
    StaticTransformBroadcaster(graph.node).sendTransform(mount)
    world.ready()
    world.send(2, 0, frame="base_link")
    graph.run_for(0.1)
    np.testing.assert_allclose(world.last_path()[-1, :2], (2, 4), atol=1e-9)
    world.send(2, 1, frame="mast")
    graph.run_for(0.1)
    np.testing.assert_allclose(world.last_path()[-1, :2], (1, 4.5), atol=1e-9)


def test_a_goal_pose_ends_with_its_heading(graph: GraphHarness) -> None:
    world = World(graph).ready()
    world.send_pose(6, 4, -math.pi / 2)
    graph.run_for(0.1)
    np.testing.assert_allclose(world.last_path()[-1], (6, 4, -math.pi / 2))


def test_missing_odometry_stops_the_robot(graph: GraphHarness) -> None:
    world = World(graph).ready()
    world.send(8, 4)
    graph.run_for(0.5)
    world.odometry = False
    before_ns = graph.now_ns
    assert graph.run_until(lambda: world.message == "stale_odometry", 2.0)
    assert (graph.now_ns - before_ns) / 1e9 <= 0.7
    assert not len(world.paths.last.poses)
    assert world.reports.last.level == b"\x01"
    world.odometry = True
    graph.run_for(1.0)
    assert world.message == "following"


def test_a_map_that_blocks_the_path_replaces_it_at_once(graph: GraphHarness) -> None:
    world = World(graph).ready()
    world.send(8, 4)
    graph.run_for(0.7)
    fill(world.occupancy, world.spec, (5, 5.2), (3, 5))
    world.send_map()
    graph.run_for(0.01)
    assert world.paths.count == 2
    assert np.abs(world.last_path()[:, 1] - 4).max() > 1


def test_a_map_in_another_frame_is_ignored(graph: GraphHarness) -> None:
    world = World(graph)
    world.send_map(frame="odom")
    graph.run_for(0.3)
    world.send(8, 4)
    graph.run_for(0.1)
    assert world.message == "waiting_for_map"


def test_the_status_is_repeated_and_latched(graph: GraphHarness) -> None:
    world = World(graph).ready()
    graph.run_for(2.0)
    late = graph.collect("/planner/status", DiagnosticStatus, latched=True)
    graph.run_for(0.01)
    assert late.last.message == "waiting_for_goal"
    assert world.reports.count >= 5


def test_parameters_change_while_it_runs(graph: GraphHarness) -> None:
    world = World(graph).ready()
    world.send(8, 4)
    graph.run_for(0.1)
    sparse = world.paths.last
    world.node.set_parameters([Parameter("path_spacing_m", value=0.05)])
    graph.run_for(0.6)
    assert len(world.paths.last.poses) > 1.9 * len(sparse.poses)


def test_a_goal_is_paused_while_navigation_is_masked(graph: GraphHarness) -> None:
    world = World(graph, progress_timeout_s=2.0, goal_timeout_s=5.0).ready()
    world.send(8.0, 4.0)
    graph.run_for(1.0)
    assert world.message == "following"
    world.commander("operator", "/cmd_vel_nav")
    assert world.message == "paused"
    paths = world.paths.count
    graph.run_for(30.0)
    assert (world.message, world.paths.count) == ("paused", paths)
    world.pose = Pose2(1, 6, 0)  # the operator has driven
    graph.run_for(1.0)
    world.commander("idle")
    assert world.message == "following"
    assert world.last_path()[0, 1] == pytest.approx(6.0, abs=0.1)
    assert world.values["replans"] == "1"


def test_a_new_goal_waits_until_navigation_commands_again(graph: GraphHarness) -> None:
    world = World(graph).ready()
    world.commander("emergency_stop", "/cmd_vel_nav,/cmd_vel_teleop")
    world.send(8.0, 4.0)
    graph.run_for(20.0)
    assert (world.message, world.paths.count) == ("paused", 0)
    world.commander("idle")
    assert world.message == "following"


def test_a_topic_cancels_the_goal(graph: GraphHarness) -> None:
    world = World(graph).ready()
    world.send(8.0, 4.0)
    graph.run_for(0.1)
    graph.publish("/cancel_goal", Empty())
    graph.run_for(0.01)
    assert (world.message, world.values["result"]) == ("canceled", "canceled")
    assert not world.paths.last.poses


def test_another_masked_topic_does_not_pause(graph: GraphHarness) -> None:
    world = World(graph).ready()
    world.send(8.0, 4.0)
    world.commander("navigation", "/dance")
    assert world.message == "following"


def test_a_service_cancels_the_goal(graph: GraphHarness) -> None:
    world = World(graph).ready()
    client = graph.node.create_client(Trigger, "/planner/cancel")
    world.send(8.0, 4.0)
    graph.run_for(1.0)
    answer = client.call_async(Trigger.Request())
    graph.run_for(0.01)
    assert answer.result().message == "goal cancelled"
    assert (world.message, world.values["result"]) == ("canceled", "canceled")
    assert not world.paths.last.poses
    answer = client.call_async(Trigger.Request())
    graph.run_for(0.01)
    assert answer.result().message == "no goal was active"


def test_a_part_of_the_map_that_blocks_the_path_replaces_it_at_once(
    graph: GraphHarness,
) -> None:
    world = World(graph).ready()
    world.begin_updates()
    world.send(8, 4)
    graph.run_for(0.7)
    fill(world.occupancy, world.spec, (5, 5.2), (3, 5))
    window = CellWindow.around(world.spec, np.array([(5.0, 3.0), (5.2, 5.0)]), 2)
    world.send_part(window)
    graph.run_for(0.01)
    assert world.paths.count == 2
    assert np.abs(world.last_path()[:, 1] - 4).max() > 1
    # The whole map with the same stamp is known; the next one is not.
    fill(world.occupancy, world.spec, (5, 5.2), (0, 8))
    world.send_map(stamp_ns=world.sent_ns)
    graph.run_for(0.5)
    assert world.message == "following"
    world.send_map()
    graph.run_for(0.5)
    assert world.message == "no_path"


def test_parts_that_are_older_or_outside_leave_the_map(graph: GraphHarness) -> None:
    world = World(graph)
    window = CellWindow(0, 20, 0, 20)
    world.send_part(window)  # before any map
    world.ready()
    sent_ns = graph.now_ns
    world.begin_updates()
    world.send(8, 4)
    graph.run_for(0.7)
    fill(world.occupancy, world.spec, (5, 5.2), (0, 8))
    whole = CellWindow.whole(world.spec.shape)
    world.send_part(whole, stamp_ns=0)
    world.send_part(whole.shifted(1, 0), cells=world.occupancy)
    world.send_part(whole, frame="odom")
    graph.run_for(0.3)
    assert world.message == "following"
    assert graph.now_ns > sent_ns
    world.send_part(whole)  # of a map that the planner does not have
    graph.run_for(0.3)
    assert world.message == "following"
    world.send_map(stamp_ns=world.sent_ns)
    graph.run_for(0.5)
    assert world.message == "no_path"


@pytest.mark.parametrize("seed", range(3))
def test_parts_give_the_same_grid_as_whole_maps(graph: GraphHarness, seed: int) -> None:
    world = World(graph).ready()
    world.begin_updates()
    rng = np.random.default_rng(seed)
    world.send(8, 4)
    for _ in range(6):
        row, column = rng.integers(0, 60, 2).tolist()
        window = CellWindow(row, row + 9, column, column + 12)
        values = np.array([-1, 0, 0, 0, 60, 100], np.int8)
        world.occupancy[window.slices] = rng.choice(values, window.shape)
        world.send_part(window)
        graph.run_for(0.25)
        fresh = Planner(world.node.params)
        fresh.set_map(NewMap(world.occupancy.copy(), world.spec))
        grid = world.node._runner.navigator.planner.grid()
        np.testing.assert_array_equal(grid.cost, fresh.grid().cost)


def test_an_update_is_used_with_its_whole_map_without_a_copy(
    graph: GraphHarness, monkeypatch: pytest.MonkeyPatch
) -> None:
    copies: list[np.ndarray] = []

    def counted(array: np.ndarray) -> np.ndarray:
        copies.append(array)
        return array.copy()

    monkeypatch.setattr(shared_cells, "copied", counted)
    world = World(graph).ready()
    world.begin_updates()
    world.send(8, 4)
    graph.run_for(0.7)
    assert world.message == "following"
    fill(world.occupancy, world.spec, (5, 5.2), (0, 8))
    world.send_part(CellWindow.whole(world.spec.shape))
    world.send_map()
    graph.run_for(0.5)
    assert (world.message, len(copies)) == ("no_path", 0)
    fill(world.occupancy, world.spec, (5, 5.2), (0, 8), 0)
    world.send_part(CellWindow.whole(world.spec.shape))  # whose map does not come
    graph.run_for(0.3)
    assert len(copies) == 1
    assert (copies[0] == 100).any(), "the array of the message, which others have, too"
    planner = world.node._runner.navigator.planner
    np.testing.assert_array_equal(planner.map.cells, world.occupancy)
