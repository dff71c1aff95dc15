"""The mission node against a scripted planner."""

from collections.abc import Iterator

import pytest

from navette.errors import InvalidValueError, ParameterError
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from navette.msgs.geometry_msgs.msg import PointStamped
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.msgs.std_msgs.msg import Header
from navette.navigation.missions.node import MissionNode
from navette.runtime import Parameter
from navette.runtime.testing import GraphHarness
from navette.runtime.time import ns_to_stamp


class FakePlanner:
    """Reaches each goal after two seconds, or fails as scripted."""

    def __init__(self, graph: GraphHarness, results: list[str]) -> None:
        self._graph = graph
        self._results = results
        self.goals: list[tuple[float, float]] = []
        self._began_ns = 0
        graph.node.create_subscription(PointStamped, "/goal_point", self._take, 10)
        graph.node.create_timer(0.5, self._report)

    def _take(self, msg: PointStamped) -> None:
        assert msg.header.frame_id == "map"
        self.goals.append((msg.point.x, msg.point.y))
        self._began_ns = self._graph.now_ns
        self._report()

    def _report(self) -> None:
        over = self._graph.now_ns - self._began_ns >= 2_000_000_000
        message = "waiting_for_goal"
        if self.goals:
            message = self._results[len(self.goals) - 1] if over else "following"
        status = DiagnosticStatus(message=message)
        status.values = [KeyValue(key="goal_id", value=str(len(self.goals)))]
        self._graph.publish("/planner/status", status, latched=True)


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness() as harness:
        yield harness


def mission(graph: GraphHarness, **params: object) -> MissionNode:
    overrides = [Parameter(name, value=value) for name, value in params.items()]
    return graph.add(MissionNode(context=graph.context, parameter_overrides=overrides))


def send_map(graph: GraphHarness) -> None:
    graph.publish("/map", OccupancyGrid(), latched=True)


def send_odometry(graph: GraphHarness, x: float) -> None:
    msg = Odometry(child_frame_id="base_link")
    msg.header.frame_id = "map"
    msg.header.stamp = ns_to_stamp(graph.now_ns)
    msg.pose.pose.position.x = x
    graph.publish("/odom/filtered", msg)


def test_goals_are_sent_in_turn_and_recorded(graph: GraphHarness) -> None:
    planner = FakePlanner(graph, ["reached", "reached", "reached"])
    node = mission(graph, goals_m=[1.0, 0.0, 3.0, 0.0])
    send_map(graph)
    graph.publish_every(
        0.1,
        "/odom/filtered",
        lambda _: Odometry(header=Header(frame_id="map"), child_frame_id="base_link"),
    )
    assert graph.run_until(lambda: node.done, 10.0)
    assert planner.goals == [(1.0, 0.0), (3.0, 0.0)]
    assert [o.result for o in node.outcomes] == ["reached", "reached"]
    assert [o.time_s for o in node.outcomes] == pytest.approx([2.0, 2.0], abs=0.51)
    node.add_goal(-1.0, 2.0)
    assert not node.done
    assert graph.run_until(lambda: node.done, 10.0)
    assert planner.goals[-1] == (-1.0, 2.0)


def test_path_length_and_distance_left_are_measured(graph: GraphHarness) -> None:
    FakePlanner(graph, ["reached"])
    send_map(graph)
    node = mission(graph, goals_m=[3.0, 0.0])
    graph.run_for(0.6)
    for k in range(6):
        send_odometry(graph, 0.5 * k)
        graph.run_for(0.1)
    assert graph.run_until(lambda: node.done, 10.0)
    [outcome] = node.outcomes
    assert outcome.path_length_m == pytest.approx(2.5)
    assert outcome.distance_left_m == pytest.approx(0.5)


def test_no_goal_is_sent_before_map_and_planner_are_available(
    graph: GraphHarness,
) -> None:
    node = mission(graph, goals_m=[1.0, 0.0])
    graph.run_for(1.0)
    planner = FakePlanner(graph, ["reached"])
    graph.run_for(1.0)
    assert planner.goals == []
    send_map(graph)
    assert graph.run_until(lambda: node.done, 10.0)
    assert len(planner.goals) == 1


@pytest.mark.parametrize("map_first", [True, False])
def test_the_order_of_map_and_status_does_not_change_when_the_first_goal_is_sent(
    graph: GraphHarness, map_first: bool
) -> None:
    """A replay of a recording may deliver both in another order than the run."""
    mission(graph, goals_m=[1.0, 0.0])
    graph.collect("/goal_point", PointStamped)
    logged = graph.collect("/rosout", "rcl_interfaces/msg/Log")
    waiting = DiagnosticStatus(message="waiting_for_goal")
    sends = [
        lambda: send_map(graph),
        lambda: graph.publish("/planner/status", waiting, latched=True),
    ]
    for send in sends if map_first else reversed(sends):
        send()
    graph.run_for(0.5)
    (sent,) = [m for m in logged.messages if m.msg.startswith("goal 1 of 1")]
    assert sent.stamp.nanosec == 100_000_000


def test_what_the_first_goal_waits_for_is_logged_once(graph: GraphHarness) -> None:
    logged = graph.collect("/rosout", "rcl_interfaces/msg/Log")
    mission(graph, goals_m=[1.0, 0.0])
    graph.run_for(30.0)
    (text,) = [m.msg for m in logged.messages if "no goal sent yet" in m.msg]
    assert "/goal_point (is a planner running?)" in text
    assert "no map has arrived on /map" in text
    assert "wait_for_map" in text


def test_a_planner_without_status_gets_the_goal(graph: GraphHarness) -> None:
    goals: list[PointStamped] = []
    graph.node.create_subscription(PointStamped, "/goal_point", goals.append, 10)
    send_map(graph)
    node = mission(graph, goals_m=[1.0, 0.0])
    send_odometry(graph, 1.0)
    graph.run_for(0.5)
    assert [(goal.point.x, goal.point.y) for goal in goals] == [(1.0, 0.0)]
    # The robot rests at the goal.
    assert graph.run_until(lambda: node.done, 5.0)
    assert node.outcomes[0].result == "reached"


@pytest.mark.parametrize(
    ("on_failure", "results"),
    [
        ("continue", ["reached", "no_path", "reached"]),
        ("stop", ["reached", "no_path", "skipped"]),
    ],
)
def test_after_a_failure_the_mission_continues_or_stops(
    graph: GraphHarness, on_failure: str, results: list[str]
) -> None:
    FakePlanner(graph, ["reached", "no_path", "reached"])
    send_map(graph)
    node = mission(graph, goals_m=[1.0, 0.0, 2.0, 0.0, 3.0, 0.0], on_failure=on_failure)
    assert graph.run_until(lambda: node.done, 20.0)
    assert [o.result for o in node.outcomes] == results


def test_a_goal_that_takes_too_long_times_out(graph: GraphHarness) -> None:
    FakePlanner(graph, ["following"])
    send_map(graph)
    node = mission(graph, goals_m=[1.0, 0.0], goal_timeout_s=3.0)
    timed_out: list[tuple[float, float]] = []
    node.on_timed_out = timed_out.append
    assert graph.run_until(lambda: node.done, 10.0)
    assert timed_out == [(1.0, 0.0)]
    assert node.outcomes[0].result == "timed_out"
    assert node.outcomes[0].time_s == pytest.approx(3.0, abs=0.11)


def test_wrong_goals_are_refused(graph: GraphHarness) -> None:
    with pytest.raises(ParameterError, match="pairs"):
        mission(graph, goals_m=[1.0, 0.0, 2.0])
    node = mission(graph)
    with pytest.raises(InvalidValueError, match="finite"):
        node.add_goal(float("nan"), 0.0)
    assert node.done


def test_goals_can_be_added_while_running(graph: GraphHarness) -> None:
    planner = FakePlanner(graph, ["reached"])
    send_map(graph)
    node = mission(graph)
    graph.run_for(1.0)
    [result] = node.set_parameters([Parameter("goals_m", value=[4.0, 5.0])])
    assert result.successful
    assert graph.run_until(lambda: node.done, 10.0)
    assert planner.goals == [(4.0, 5.0)]
