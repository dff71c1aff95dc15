"""navette topic echo: exact text, parts, filters, QoS; in virtual time."""

import json
from array import array
from collections.abc import Callable
from typing import Any

import click
import pytest
from topic_world import navette, program, shared_graph

from navette.cli.session import connect
from navette.cli.topic.echo import echo
from navette.cli.topic.echo_options import EchoOptions, Style
from navette.cli.topic.options import QosOverrides
from navette.errors import InvalidValueError, MessageError
from navette.msgs.expressions import ExpressionError
from navette.msgs.geometry_msgs.msg import Point, Pose, PoseArray
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.msgs.std_msgs.msg import Float64, Header, Int32, String
from navette.runtime import (
    DurabilityPolicy,
    Node,
    QoSProfile,
    qos_profile_sensor_data,
)

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def publish_each(talker: Node, topic: str, make: Callable[[int], Any]) -> None:
    """A message every 0.1 s: made of 1, 2, 3, …"""
    publisher = talker.create_publisher(type(make(0)), topic, 10)
    numbers = iter(range(1, 1000))
    talker.create_timer(0.1, lambda: publisher.publish(make(next(numbers))))


def latch(talker: Node, topic: str, message: Any) -> None:
    talker.create_publisher(type(message), topic, LATCHED).publish(message)


def echo_of(talker: Node, topic: str, **options: Any) -> None:
    options.setdefault("timeout_s", 60.0)
    style = {k: options.pop(k) for k in tuple(options) if hasattr(Style, k)}
    with connect(talker.context) as node:
        echo(node, EchoOptions(topic=topic, style=Style(**style), **options))


def test_messages_as_ros2_prints_them(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    publish_each(talker, "chatter", lambda i: String(data=f"Hello {i}"))
    echo_of(talker, "chatter", count=2)
    assert capsys.readouterr().out == "data: Hello 1\n---\ndata: Hello 2\n---\n"


def test_a_latched_message_is_shown_at_once(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    latch(talker, "origin", Header(frame_id="map"))
    echo_of(talker, "origin", count=1)
    assert capsys.readouterr().out == (
        "stamp:\n  sec: 0\n  nanosec: 0\nframe_id: map\n---\n"
    )
    assert talker.context.clock.now_ns == 0


def test_best_effort_publishers_are_received(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    publisher = talker.create_publisher(Int32, "n", qos_profile_sensor_data)
    talker.create_timer(0.1, lambda: publisher.publish(Int32(data=7)))
    echo_of(talker, "n", count=1)
    assert capsys.readouterr().out == "data: 7\n---\n"


SCAN = LaserScan(ranges=[float(i) for i in range(200)], intensities=[1.5])


@pytest.mark.parametrize(
    ("options", "last_lines"),
    [
        ({"truncate_length": 2},
         "ranges:\n- 0.0\n- 1.0\n- '...'\nintensities:\n- 1.5\n---"),
        ({"no_arr": True}, "ranges: '<sequence type: float, length: 200>'\n"
                           "intensities: '<sequence type: float, length: 1>'\n---"),
        ({"paths": ["ranges[3]"]}, "3.0\n---"),
        ({"paths": ["ranges[-2:]"]}, "- 198.0\n- 199.0\n---"),
        ({"paths": ["ranges"], "truncate_length": 1}, "- 0.0\n- '...'\n---"),
        ({"paths": ["ranges"], "truncate_length": 1, "flow_style": True},
         "[0.0, '...']\n---"),
        ({"paths": ["intensities"], "csv": True}, "1.5"),
        ({"paths": ["header"], "csv": True}, "0,0,"),
        ({"paths": ["header.stamp"], "flow_style": True}, "{sec: 0, nanosec: 0}\n---"),
        ({"paths": ["header.stamp.sec"]}, "0\n---"),
        ({"paths": ["intensities"], "as_json": True}, "[1.5]"),
        ({"paths": ["ranges[1]", "header.stamp"]}, "1.0\nsec: 0\nnanosec: 0\n---"),
        ({"paths": ["ranges[1]", "header.stamp"], "csv": True}, "1.0,0,0"),
        ({"paths": ["ranges[1]", "header.stamp.sec"], "as_json": True},
         '{"ranges[1]": 1.0, "header.stamp.sec": 0}'),
    ],
)  # fmt: skip
def test_shortening_and_parts(
    talker: Node,
    capsys: pytest.CaptureFixture[str],
    options: dict[str, Any],
    last_lines: str,
) -> None:
    latch(talker, "scan", SCAN)
    echo_of(talker, "scan", count=1, **options)
    out = capsys.readouterr().out
    whole = "paths" in options
    assert out == f"{last_lines}\n" if whole else out.endswith(f"{last_lines}\n")


def test_arrays_are_cut_at_128_items_unless_asked(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    latch(talker, "scan", SCAN)
    echo_of(talker, "scan", count=1, paths=["ranges"])
    assert capsys.readouterr().out.count("\n") == 128 + 2  # the dots and the dashes
    echo_of(talker, "scan", count=1, paths=["ranges"], truncate_length=None)
    assert capsys.readouterr().out.count("\n") == 200 + 1


def test_json_is_a_line_each_with_arrays_whole(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    latch(talker, "scan", SCAN)
    echo_of(talker, "scan", count=1, as_json=True)
    (line,) = capsys.readouterr().out.splitlines()
    assert LaserScan(ranges=json.loads(line)["ranges"]).ranges == SCAN.ranges


def test_csv_of_a_whole_message(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    publish_each(talker, "p", lambda i: Point(x=float(i), y=0.5))
    echo_of(talker, "p", count=2, csv=True)
    assert capsys.readouterr().out == "1.0,0.5,0.0\n2.0,0.5,0.0\n"


def test_raw_bytes(talker: Node, capsys: pytest.CaptureFixture[str]) -> None:
    latch(talker, "n", Int32(data=258))
    echo_of(talker, "n", count=1, raw=True)
    expected = b"\x00\x01\x00\x00\x02\x01\x00\x00"
    assert capsys.readouterr().out == f"{expected!r}\n---\n"


def test_message_info_comes_before_the_message(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    publish_each(talker, "chatter", lambda i: String(data=f"{i}"))
    echo_of(talker, "chatter", count=1, with_info=True)
    assert capsys.readouterr().out == (
        "publication_sequence_number: 1\nreceived_timestamp: 100000000\n"
        "reception_sequence_number: 1\nsource_timestamp: 100000000\n"
        "---\ndata: '1'\n---\n"
    )


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("m.data > 2.5", "3.0\n4.0\n"),
        ("m.data % 2 == 0 and m.data != 2", "4.0\n6.0\n"),
        ("abs(m.data - 5) <= 0", "5.0\n"),
    ],
)
def test_filters_choose(
    talker: Node, capsys: pytest.CaptureFixture[str], expression: str, expected: str
) -> None:
    publish_each(talker, "x", lambda i: Float64(data=float(i)))
    count = expected.count("\n")
    echo_of(talker, "x", count=count, filter=expression, csv=True)
    assert capsys.readouterr().out == expected


def test_filters_look_into_arrays_and_constants(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    latch(talker, "scan", SCAN)
    text = (
        "any(r > 198 for r in m.ranges) and len(m.ranges) == 200 and m.ranges[0] == 0"
    )
    echo_of(talker, "scan", count=1, filter=text, paths=["intensities"], csv=True)
    assert capsys.readouterr().out == "1.5\n"


@pytest.mark.parametrize(
    "hostile",
    [
        "__import__('os').system('true')",
        "m.__class__.__mro__",
        "m.data.__class__",
        "9 ** 9 ** 9",
        "open('/etc/passwd')",
        "(lambda: 1)()",
        "m.get_fields_and_field_types()",
        "[1 for a in 'x' * 9999 for b in 'x' * 9999]",
        "eval('1')",
    ],
)
def test_hostile_filters_are_refused(talker: Node, hostile: str) -> None:
    latch(talker, "chatter", String(data="x"))
    with pytest.raises(ExpressionError):
        echo_of(talker, "chatter", count=1, filter=hostile)


def test_a_wrong_filter_is_refused_before_any_message(talker: Node) -> None:
    talker.create_publisher(String, "silent", 10)
    with pytest.raises(ExpressionError, match="unknown name 'data'"):
        echo_of(talker, "silent", count=1, filter="data == 1")


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        ("poses.position", r"is an array; add an index, as in \[0\], before .position"),
        ("poses[0].place", "no such field; known: position, orientation"),
        ("header.frame_id.x", "string has no fields"),
        ("header[0]", "is not an array"),
        ("poses[", "is not a path"),
        ("..", "is not a path"),
        ("poses[99999999999]", "is not a path"),
        ("a" * 2000, "is not a path"),
        ("__class__", "is not a path|no such field"),
    ],
)
def test_wrong_paths_are_refused_before_any_message(
    talker: Node, path: str, reason: str
) -> None:
    talker.create_publisher(PoseArray, "poses", 10)
    with pytest.raises(MessageError, match=reason):
        echo_of(talker, "poses", count=1, paths=[path])


def test_a_path_into_many_skips_messages_that_are_too_short(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    def poses(i: int) -> PoseArray:
        return PoseArray(poses=[Pose(position=Point(x=float(i)))] * (i % 3))

    publish_each(talker, "poses", poses)
    echo_of(talker, "poses", count=2, paths=["poses[1].position.x"])
    shown = capsys.readouterr()
    assert shown.out == "2.0\n---\n5.0\n---\n"
    assert (
        shown.err
        == "poses[1].position.x: skipping messages whose arrays are too short\n"
    )


def test_echo_waits_for_a_topic_and_reports_it(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    timer = talker.create_timer(2.0, lambda: begin())

    def begin() -> None:
        timer.cancel()
        publish_each(talker, "late", lambda i: String(data=f"{i}"))

    echo_of(talker, "late", count=1, paths=["data"])
    shown = capsys.readouterr()
    assert shown.out == "1\n---\n"
    assert shown.err == "waiting for a publisher on /late\n"


def test_waiting_ends(talker: Node, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(click.exceptions.Exit) as ended:
        echo_of(talker, "never", timeout_s=3.0)
    assert ended.value.exit_code == 1
    assert "no publisher on /never in 3 s" in capsys.readouterr().err
    talker.create_publisher(String, "silent", 10)
    with pytest.raises(click.exceptions.Exit):
        echo_of(talker, "silent", timeout_s=2.0, count=1)
    assert "messages received on /silent: 0 in 2 s" in capsys.readouterr().err


def test_a_timeout_after_messages_is_a_success(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    publish_each(talker, "x", lambda i: Int32(data=i))
    echo_of(talker, "x", timeout_s=0.35, csv=True)
    assert capsys.readouterr().out == "1\n2\n3\n"


def test_another_type_than_published_is_refused(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    talker.create_publisher(String, "chatter", 10)
    with pytest.raises(click.exceptions.Exit):
        echo_of(talker, "chatter", type_name="std_msgs/Bool")
    assert (
        "/chatter has type std_msgs/msg/String, not std_msgs/msg/Bool"
        in capsys.readouterr().err
    )


@pytest.mark.filterwarnings("ignore")
def test_qos_wishes_are_kept(talker: Node) -> None:
    talker.create_publisher(String, "chatter", 10)
    with pytest.raises(click.exceptions.Exit):
        echo_of(
            talker, "chatter", count=1, timeout_s=1.0,
            qos=QosOverrides(durability="transient_local", reliability="reliable"),
        )  # fmt: skip
    with pytest.raises(InvalidValueError, match=r"--qos-reliability 'sure'.*reliable"):
        echo_of(talker, "chatter", qos=QosOverrides(reliability="sure"))


def test_on_a_terminal_names_are_coloured_and_control_characters_do_not_act(
    talker: Node, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in ("output", "message_yaml"):  # which is where each looks it up
        monkeypatch.setattr(f"navette.cli.{module}.is_terminal", lambda: True)
    monkeypatch.delenv("NO_COLOR", raising=False)
    latch(talker, "chatter", String(data="a\x1b[2Jb"))
    echo_of(talker, "chatter", count=1)
    assert capsys.readouterr().out == (
        '\x1b[36mdata\x1b[0m: "a\\e[2Jb"\n\x1b[2m---\x1b[0m\n'
    )
    echo_of(talker, "chatter", count=1, paths=["data"])
    assert "\x1b[2J" not in capsys.readouterr().out


def test_an_overwritten_message_fits_the_screen(
    talker: Node,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for module in ("output", "topic.echo"):
        monkeypatch.setattr(f"navette.cli.{module}.is_terminal", lambda: True)
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "40")
    monkeypatch.setenv("LINES", "6")
    latch(talker, "scan", SCAN)
    echo_of(talker, "scan", count=1, clear=True)
    lines = capsys.readouterr().out.replace("\x1b[K", "").splitlines()
    assert lines[-2:] == ["    nanosec: 0", "…\x1b[J"]
    latch(talker, "text", String(data="x" * 100))
    echo_of(talker, "text", count=1, clear=True)
    assert capsys.readouterr().out.endswith("xxx\x1b[K\n---\x1b[K\x1b[J\n")


def test_clearing_prints_each_over_the_last(
    talker: Node, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in ("output", "topic.echo"):
        monkeypatch.setattr(f"navette.cli.{module}.is_terminal", lambda: True)
    monkeypatch.setenv("NO_COLOR", "1")
    publish_each(talker, "x", lambda i: Int32(data=i))
    echo_of(talker, "x", count=2, clear=True)
    assert capsys.readouterr().out == (
        "\x1b[2J\x1b[Hdata: 1\x1b[K\n---\x1b[K\x1b[J\n"
        "\x1b[Hdata: 2\x1b[K\n---\x1b[K\x1b[J\n"
    )


def test_the_command_passes_its_options_on() -> None:
    with shared_graph(), program("talker") as talker:
        latch(talker, "scan", LaserScan(ranges=array("f", [1.0, 2.0, 3.0])))
        shown = navette(
            "topic", "echo", "/scan", "sensor_msgs/msg/LaserScan", "--once",
            "--field", "ranges", "-l", "2", "--timeout", "5",
        )  # fmt: skip
    assert (shown.exit_code, shown.stdout) == (0, "- 1.0\n- 2.0\n- '...'\n---\n")


def test_on_a_terminal_numbers_stand_beside_each_other(
    talker: Node, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("navette.cli.message_yaml.is_terminal", lambda: True)
    monkeypatch.setenv("NO_COLOR", "1")
    scan = LaserScan(ranges=[1.5, float("inf"), 1e-30, 4.0], intensities=[-1.0])
    latch(talker, "scan", scan)
    echo_of(talker, "scan", count=1, truncate_length=3)
    assert capsys.readouterr().out.splitlines()[-3:] == [
        "ranges: [1.5, .inf, 1.0000000031710769e-30, '...']",
        "intensities: [-1.0]",
        "---",
    ]
    echo_of(talker, "scan", count=1, paths=["ranges[:2]"])
    assert capsys.readouterr().out == "[1.5, .inf]\n---\n"
    latch(talker, "poses", PoseArray(poses=[Pose()]))
    echo_of(talker, "poses", count=1, paths=["poses"])
    assert capsys.readouterr().out.splitlines()[:2] == ["- position:", "    x: 0.0"]


@pytest.mark.filterwarnings("ignore")
def test_of_several_types_the_published_one_is_printed(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    both = [Int32, String]
    for kind in both:
        talker.create_subscription(kind, "both", print, 10, other_types=both)
    message = String(data="here")
    talker.create_publisher(String, "both", LATCHED, other_types=both).publish(message)
    echo_of(talker, "both", once=True)
    assert "data: here" in capsys.readouterr().out
