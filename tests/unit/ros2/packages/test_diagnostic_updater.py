"""diagnostic_updater: statuses, tasks, and the published messages."""

from typing import Any

import pytest

from navette.errors import CallbackError
from navette.msgs.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.ros2.packages.diagnostic_updater import (
    CompositeDiagnosticTask,
    DiagnosedPublisher,
    DiagnosticStatusWrapper,
    DiagnosticTask,
    FrequencyStatusParam,
    FunctionDiagnosticTask,
    HeaderlessTopicDiagnostic,
    Heartbeat,
    TimeStampStatus,
    TimeStampStatusParam,
    TopicDiagnostic,
    Updater,
)
from navette.runtime import Node, Parameter, Time
from navette.runtime.testing import GraphHarness

OK, WARN = DiagnosticStatus.OK, DiagnosticStatus.WARN
ERROR, STALE = DiagnosticStatus.ERROR, DiagnosticStatus.STALE


def status(level: bytes, message: str) -> DiagnosticStatusWrapper:
    return DiagnosticStatusWrapper(level=level, message=message)


def fine(stat: Any) -> Any:
    stat.summary(OK, "fine")
    return stat


def published_statuses(graph: GraphHarness) -> list[Any]:
    """Return the list that collects the statuses on /diagnostics."""
    statuses: list[Any] = []
    graph.node.create_subscription(
        DiagnosticArray, "/diagnostics", lambda m: statuses.extend(m.status), 10
    )
    return statuses


def driver(graph: GraphHarness, **options: Any) -> Node:
    return graph.add(Node("driver", context=graph.context, **options))


def values(stat: Any) -> dict[str, str]:
    return {each.key: each.value for each in stat.values}


@pytest.mark.parametrize(
    ("first", "second", "merged"),
    [
        ((OK, "a"), (OK, "b"), (OK, "a; b")),
        ((OK, ""), (OK, "b"), (OK, "b")),
        ((OK, "a"), (WARN, "b"), (WARN, "b")),
        ((WARN, "a"), (OK, "b"), (WARN, "a")),
        ((WARN, "a"), (ERROR, "b"), (ERROR, "a; b")),
        ((STALE, "a"), (WARN, "b"), (STALE, "a; b")),
    ],
)
def test_summaries_are_merged(first: Any, second: Any, merged: Any) -> None:
    stat = status(*first)
    stat.mergeSummary(*second)
    assert (stat.level, stat.message) == merged
    stat = status(*first)
    stat.mergeSummary(status(*second))
    assert (stat.level, stat.message) == merged


def test_filling_a_status() -> None:
    stat = status(ERROR, "x")
    stat.add("count", 3)
    stat.add("ok", True)
    assert values(stat) == {"count": "3", "ok": "True"}
    stat.clearSummary()
    assert (stat.level, stat.message) == (OK, "")
    with pytest.raises(TypeError, match="a level and a message"):
        stat.summary()


def test_a_composite_has_the_worst_level_and_all_values() -> None:
    def hot(stat: Any) -> Any:
        stat.summary(WARN, "hot")
        stat.add("°C", 80)
        return stat

    both = CompositeDiagnosticTask("both")
    both.addTask(FunctionDiagnosticTask("a", hot))
    both.addTask(Heartbeat())
    stat = both.run(status(ERROR, "No message was set"))
    assert (stat.level, stat.message) == (WARN, "hot")
    assert values(stat) == {"°C": "80"}
    assert both.getName() == "both"


def test_an_updater_publishes_every_second(graph: GraphHarness) -> None:
    statuses = published_statuses(graph)
    updater = Updater(driver(graph))
    updater.setHardwareID("none")
    updater.add("motor", fine)
    updater.add(Heartbeat())
    graph.run_for(0.5)
    assert [(s.name, s.message) for s in statuses] == [
        ("driver: motor", "Node starting up"),
        ("driver: Heartbeat", "Node starting up"),
    ]
    del statuses[:]
    graph.run_for(2.0)
    assert [(s.name, s.level, s.message, s.hardware_id) for s in statuses] == [
        ("driver: motor", OK, "fine", "none"),
        ("driver: Heartbeat", OK, "Alive", "none"),
    ] * 2
    assert updater.removeByName("motor")
    assert not updater.removeByName("motor")
    del statuses[:]
    updater.broadcast(WARN, "going down")
    graph.run_for(0.1)
    assert [(s.name, s.message) for s in statuses] == [
        ("driver: Heartbeat", "going down")
    ]


def test_period_and_full_name_are_parameters(graph: GraphHarness) -> None:
    statuses = published_statuses(graph)
    overrides = [
        Parameter("diagnostic_updater.period", value=0.1),
        Parameter("diagnostic_updater.use_fqn", value=True),
    ]
    node = driver(graph, namespace="/left", parameter_overrides=overrides)
    updater = Updater(node)
    updater.add("motor", fine)
    second = Updater(node)  # of the same node
    assert (updater.period, second.period) == (0.1, 0.1)
    second.period = 60.0
    graph.run_for(1.05)
    assert len(statuses) == 11
    assert statuses[-1].name == "/left/driver: motor"
    updater.period = 0.5
    graph.run_for(1.05)
    assert len(statuses) == 13


def test_a_missing_hardware_id_is_logged_once(
    graph: GraphHarness, capsys: pytest.CaptureFixture[str]
) -> None:
    updater = Updater(driver(graph))
    updater.add("motor", fine)
    updater.verbose = True
    graph.run_for(3.0)
    assert capsys.readouterr().err.count("hardware ID is not set") == 1


def test_the_error_of_a_task_without_result_names_it(graph: GraphHarness) -> None:
    updater = Updater(driver(graph))
    updater.add("motor", lambda stat: None)
    with pytest.raises(CallbackError, match="'motor' must return the status"):
        graph.run_for(1.0)


def test_the_rate_of_a_topic(graph: GraphHarness) -> None:
    node = driver(graph)
    updater = Updater(node, period=1000.0)
    bounds = {"min": 8.0, "max": 12.0}
    topic = HeaderlessTopicDiagnostic(
        "scan", updater, FrequencyStatusParam(bounds, 0.1, 2)
    )

    def after(ticks: int) -> Any:
        for _ in range(ticks):
            topic.tick()
        graph.run_for(1.0)
        return topic.run(DiagnosticStatusWrapper())

    assert after(0).message == "No events recorded."
    stat = after(20)
    assert (stat.level, stat.message) == (OK, "Desired frequency met")
    assert values(stat) == {
        "Events in window": "20",
        "Events since startup": "20",
        "Duration of window (s)": "2.000000",
        "Actual frequency (Hz)": "10.000000",
        "Minimum acceptable frequency (Hz)": "7.200000",
        "Maximum acceptable frequency (Hz)": "13.200000",
    }
    assert (after(30).level, after(1).message) == (WARN, "Frequency too high.")
    bounds["min"] = bounds["max"] = 10.0
    stat = after(2)
    assert stat.message == "Frequency too low."
    assert values(stat)["Target frequency (Hz)"] == "10.000000"
    topic.clear_window()
    assert topic.run(DiagnosticStatusWrapper()).level == ERROR


def test_two_runs_at_one_instant_have_no_rate(graph: GraphHarness) -> None:
    updater = Updater(driver(graph))
    topic = HeaderlessTopicDiagnostic("t", updater, FrequencyStatusParam({"min": 1.0}))
    topic.tick()
    assert (
        values(topic.run(DiagnosticStatusWrapper()))["Actual frequency (Hz)"] == "nan"
    )


def test_the_age_of_stamps(graph: GraphHarness) -> None:
    node = driver(graph)
    graph.run_for(100.0)
    stamps = TimeStampStatus(TimeStampStatusParam(-1, 5), clock=node.get_clock())

    def after(*seconds: float) -> Any:
        for each in seconds:
            stamps.tick(each)
        return stamps.run(DiagnosticStatusWrapper())

    assert after().message == "No data since last update."
    stat = after(99.0, 100.5)
    assert (stat.level, stat.message) == (OK, "Timestamps are reasonable.")
    assert values(stat)["Earliest timestamp delay:"] == "-0.500000"
    assert values(stat)["Latest timestamp delay:"] == "1.000000"
    assert after(102.0).message == "Timestamps too far in future seen."
    assert after(90.0).message == "Timestamps too far in past seen."
    stat = after(0.0)
    assert (stat.level, stat.message) == (ERROR, "Zero timestamp seen.")
    counts = [values(stat)[f"{k} diagnostic update count:"] for k in ("Late", "Early")]
    assert counts == ["1", "1"]
    stamps.tick(Time(seconds=100))
    assert stamps.run(DiagnosticStatusWrapper()).level == OK


def test_a_diagnosed_publisher(graph: GraphHarness) -> None:
    node = driver(graph)
    updater = Updater(node, period=1.0)
    statuses = published_statuses(graph)
    publisher = DiagnosedPublisher(
        node.create_publisher(LaserScan, "scan", 10),
        updater,
        FrequencyStatusParam({"min": 10.0, "max": 10.0}),
        TimeStampStatusParam(),
    )
    assert isinstance(publisher, (TopicDiagnostic, DiagnosticTask))

    def send() -> None:
        scan = LaserScan()
        scan.header.stamp = node.get_clock().now().to_msg()
        publisher.publish(scan)

    node.create_timer(0.1, send)
    graph.run_for(1.0)
    assert statuses[-1].name == "driver: /scan topic status"
    assert statuses[-1].message == "Desired frequency met; Timestamps are reasonable."
