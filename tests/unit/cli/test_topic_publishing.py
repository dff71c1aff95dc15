"""navette topic pub: partial YAML, stamps, rates, waiting; in virtual time."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click
import pytest
from topic_world import navette, program, shared_graph

from navette.cli.request_builder import from_yaml
from navette.cli.session import connect
from navette.cli.topic.options import QosOverrides
from navette.cli.topic.pub_options import PublishOptions
from navette.cli.topic.publishing import filled_message, publish
from navette.errors import InvalidValueError, UnknownNameError
from navette.msgs.geometry_msgs.msg import PointStamped, Twist
from navette.msgs.rosgraph_msgs.msg import Clock
from navette.msgs.std_msgs.msg import Empty, String
from navette.runtime import Context, Executor, Node, SystemClock, VirtualClock
from navette.runtime.time import ns_to_stamp


@pytest.fixture
def listener() -> Iterator[Node]:
    with Context(clock=VirtualClock()) as context:
        node = Node("listener", context=context, start_parameter_services=False)
        Executor(context=context).add_node(node)
        yield node


def collect(listener: Node, kind: type, topic: str) -> list[tuple[float, Any]]:
    """(time in s, message) of all that comes."""
    received: list[tuple[float, Any]] = []
    clock = listener.get_clock()
    listener.create_subscription(
        kind, topic, lambda m: received.append((clock.now_ns / 1e9, m)), 10
    )
    return received


def pub(listener: Node, topic: str, type_name: str, **options: Any) -> None:
    with connect(listener.context) as node:
        publish(node, PublishOptions(topic=topic, type_name=type_name, **options))


def test_partial_yaml_at_a_rate_as_ros2_prints_it(
    listener: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    received = collect(listener, Twist, "cmd_vel")
    pub(
        listener, "cmd_vel", "geometry_msgs/msg/Twist",
        values="{linear: {x: 2.0}, angular: {z: 1.8}}", rate_hz=2.0, times=3,
    )  # fmt: skip
    assert [time for time, _ in received] == [0.0, 0.5, 1.0]
    assert received[-1][1].linear.x == 2.0
    assert received[-1][1].angular.z == 1.8
    assert received[-1][1].linear.y == 0.0
    lines = capsys.readouterr().out.split("\n")
    assert lines[0] == "publisher: beginning loop"
    assert lines[1] == f"publishing #1: {received[0][1]!r}"
    assert lines[2:4] == ["", f"publishing #2: {received[0][1]!r}"]


def test_every_nth_is_printed(
    listener: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    collect(listener, String, "chatter")
    pub(listener, "chatter", "std_msgs/String", times=4, print_each=2)
    assert [
        line.partition(":")[0] for line in capsys.readouterr().out.splitlines() if line
    ] == ["publisher", "publishing #2", "publishing #4"]
    pub(listener, "chatter", "std_msgs/String", times=2, print_each=0)
    assert capsys.readouterr().out == "publisher: beginning loop\n"


def test_headers_and_times_are_stamped_when_sent(listener: Node) -> None:
    received = collect(listener, PointStamped, "goal")
    values = "{header: auto, point: {x: 1.0}}"
    pub(listener, "goal", "geometry_msgs/PointStamped", values=values, times=2)
    assert [m.header.stamp for _, m in received] == [ns_to_stamp(0), ns_to_stamp(10**9)]

    message, stamps = filled_message(
        PointStamped, {"header": {"stamp": "now", "frame_id": "map"}}
    )
    for stamp in stamps:
        stamp(ns_to_stamp(7))
    assert message.header.stamp.nanosec == 7
    assert message.header.frame_id == "map"


def test_the_output_of_echo_can_be_published(listener: Node, tmp_path: Path) -> None:
    received = collect(listener, Twist, "cmd_vel")
    file = tmp_path / "drive.yaml"
    file.write_text("linear:\n  x: 1.0\n---\nlinear:\n  x: 2.0\n---\n")
    pub(listener, "cmd_vel", "geometry_msgs/Twist", yaml_file=file, rate_hz=2.0)
    assert [(at_s, m.linear.x) for at_s, m in received] == [(0.0, 1.0), (0.5, 2.0)]
    pub(listener, "cmd_vel", "geometry_msgs/Twist", yaml_file=file, once=True)
    assert [m.linear.x for _, m in received] == [1.0, 2.0, 1.0]
    for text, reason in (("---\n", "no message"), ("{", "is not YAML"), (None, "No")):
        other = tmp_path / "other.yaml"
        if text:
            other.write_text(text)
        else:
            other.unlink()
        with pytest.raises(InvalidValueError, match=reason):
            pub(listener, "cmd_vel", "geometry_msgs/Twist", yaml_file=other)


def test_a_value_alone_is_the_field_of_a_message_that_has_one() -> None:
    assert filled_message(String, "hello")[0] == String(data="hello")
    assert filled_message(String, 5)[0] == String(data="5")
    assert filled_message(Empty, None)[0] == Empty()


@pytest.mark.parametrize(
    ("kind", "text", "reason"),
    [
        (Twist, "{linear: {w: 1}}", "has no field 'w'; its fields: x, y, z"),
        (Twist, "{linear: {x: far}}", "'far'"),
        (Twist, "1.0", "geometry_msgs/msg/Twist needs its fields by name"),
        (Twist, "[1, 2]", "its fields are linear, angular"),
        (Empty, "1", "its fields are none"),
        (Twist, "{linear: [", "is not YAML"),
        (String, "!!python/object/apply:os.system ['true']", "is not YAML"),
    ],
)
def test_values_of_the_wrong_form_are_errors(kind: Any, text: str, reason: str) -> None:
    with pytest.raises(InvalidValueError, match=reason):
        filled_message(kind, from_yaml(text))


def test_publishing_waits_for_subscriptions(
    listener: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    received: list[Any] = []
    timer = listener.create_timer(2.5, lambda: join())

    def join() -> None:
        timer.cancel()
        received.extend([None])
        listener.create_subscription(String, "chatter", received.append, 10)

    pub(listener, "chatter", "std_msgs/String", values="{data: hi}", times=1)
    assert received == [None, String(data="hi")]
    assert capsys.readouterr().err == "waiting for 1 matching subscription(s)\n"


def test_missing_subscriptions_are_explained(
    listener: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    listener.create_subscription(String, "chatter", lambda _: None, 10)
    lines = []
    for topic, qos in (("chattr", QosOverrides()),
                       ("chatter", QosOverrides(reliability="best_effort")),
                       ):  # fmt: skip
        with pytest.raises(click.exceptions.Exit):
            pub(listener, topic, "std_msgs/String", times=1, max_wait_s=1.0, qos=qos)
        lines += capsys.readouterr().err.splitlines()[-2:-1]
    assert lines == [
        "waiting for 1 matching subscription(s); did you mean /chatter?",
        "waiting for 1 matching subscription(s); 1 of /chatter have incompatible QoS",
    ]


def test_waiting_for_subscriptions_ends(
    listener: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(click.exceptions.Exit) as ended:
        pub(listener, "chatter", "std_msgs/String", wait_for=2, max_wait_s=1.5)
    assert ended.value.exit_code == 1
    shown = capsys.readouterr()
    assert shown.err.endswith("0 of 2 subscriptions to /chatter matched in 1.5 s\n")
    assert shown.err.count("waiting") == 1
    with pytest.raises(InvalidValueError, match="has no effect without"):
        pub(listener, "chatter", "std_msgs/String", max_wait_s=1.5)


def test_a_topic_of_another_type_and_an_unknown_type_are_refused(
    listener: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    collect(listener, String, "chatter")
    with pytest.raises(click.exceptions.Exit):
        pub(listener, "chatter", "std_msgs/Bool", times=1)
    assert "/chatter has type std_msgs/msg/String" in capsys.readouterr().err
    with pytest.raises((click.exceptions.Exit, UnknownNameError)):
        pub(listener, "other", "no_such_msgs/msg/Thing", times=1)
    assert "no_such_msgs" in capsys.readouterr().err


def test_the_command() -> None:
    with shared_graph(), program("listener") as listener:
        received: list[String] = []
        listener.create_subscription(String, "chatter", received.append, 10)
        shown = navette(
            "topic", "pub", "-1", "--keep-alive", "0", "/chatter",
            "std_msgs/msg/String", "{data: Hello}",
        )  # fmt: skip
        listener.executor.spin_once(0.1)
    assert shown.exit_code == 0, shown.output
    assert received == [String(data="Hello")]
    assert shown.stdout == (
        "publisher: beginning loop\n"
        "publishing #1: std_msgs.msg.String(data='Hello')\n\n"
    )


@pytest.mark.parametrize(
    ("options", "reason"),
    [(["-1", "-t", "3"], "cannot be combined"), (["-r", "0"], "above 0")],
)
def test_conflicting_options_are_errors(options: list[str], reason: str) -> None:
    shown = navette("topic", "pub", "/x", "std_msgs/msg/String", *options)
    assert isinstance(shown.exception, InvalidValueError)
    assert reason in str(shown.exception)


def test_stamps_are_in_simulated_time_where_there_is_a_clock() -> None:
    with Context(clock=SystemClock()) as context:
        node = Node("simulator", context=context, start_parameter_services=False)
        Executor(context=context).add_node(node)
        clock = node.create_publisher(Clock, "/clock", 10)
        message = Clock(clock=ns_to_stamp(42 * 10**9))
        node.create_timer(0.005, lambda: clock.publish(message))
        received: list[PointStamped] = []
        node.create_subscription(PointStamped, "goal", received.append, 10)
        for wall_time in (False, True):
            pub(
                node, "goal", "geometry_msgs/PointStamped", values="{header: auto}",
                times=1, keep_alive_s=0.0, print_each=0, wall_time=wall_time,
            )  # fmt: skip
    assert received[0].header.stamp.sec == 42
    assert received[1].header.stamp.sec > 10**9
