"""navette topic hz, bw, delay: figures of known series, text as ros2 prints it."""

import json
from collections.abc import Callable
from typing import Any

import click
import pytest
from topic_world import navette

from navette.cli.session import connect, follow_clock, is_simulated
from navette.cli.topic.measuring import MeasureOptions, measure
from navette.cli.topic.meters import (
    DelayMeter,
    Load,
    LoadMeter,
    Meter,
    RateMeter,
    Spread,
)
from navette.cli.topic.options import QosOverrides
from navette.cli.topic.verbs import wrong_clock_remark
from navette.errors import InvalidValueError
from navette.msgs import serialize
from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.rosgraph_msgs.msg import Clock
from navette.msgs.sensor_msgs.msg import Imu
from navette.msgs.std_msgs.msg import Header, Int32, String
from navette.runtime import (
    Context,
    Executor,
    Node,
    ReliabilityPolicy,
    SystemClock,
)
from navette.runtime.time import ns_to_stamp, stamp_to_ns

MS = 1_000_000
RATE = {"make_meter": lambda: RateMeter(10_000)}
DELAY = {
    "make_meter": lambda: DelayMeter(10_000),
    "raw": False,
    "needs_header": True,
    "value": lambda message: stamp_to_ns(message.header.stamp),
}


def publish_each(
    talker: Node, topic: str, period_s: float, make: Callable[[int], Any]
) -> None:
    """``make(now_ns)`` at a period."""
    publisher = talker.create_publisher(type(make(0)), topic, 10)
    clock = talker.get_clock()
    talker.create_timer(period_s, lambda: publisher.publish(make(clock.now_ns)))


def run(talker: Node, *topics: str, **options: Any) -> None:
    options.setdefault("count", 1)
    with connect(talker.context) as node:
        measure(node, MeasureOptions(topics=list(topics), **options))


def test_hz_as_ros2_prints_it(talker: Node, capsys: pytest.CaptureFixture[str]) -> None:
    publish_each(talker, "chatter", 0.1, lambda _: String())
    run(talker, "chatter", count=2, **RATE)
    assert capsys.readouterr().out == (
        "average rate: 10.000\n"
        "\tmin: 0.100s max: 0.100s std dev: 0.00000s window: 8\n"
        "average rate: 10.000\n"
        "\tmin: 0.100s max: 0.100s std dev: 0.00000s window: 18\n"
    )


def test_a_topic_without_publisher_does_not_block_the_others(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    publish_each(talker, "chatter", 0.1, lambda _: String())

    def begin() -> None:
        late.cancel()
        publish_each(talker, "later", 0.05, lambda _: String())

    late = talker.create_timer(1.5, begin)
    run(talker, "chatter", "chater", "later", count=3, **RATE)
    out, err = capsys.readouterr()
    assert "no publisher on /chater yet; did you mean /chatter?" in err
    tables = out.split("topic")[1:]
    assert ["/later" in table for table in tables] == [False, False, True]


def test_all_topics_including_later_ones(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    publish_each(talker, "chatter", 0.1, lambda _: String())
    publish_each(talker, "_own", 0.1, lambda _: String())
    run(
        talker, all_topics=True, make_meter=lambda: LoadMeter(100), value=len, count=2
    )  # fmt: skip
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["topic", "bandwidth", "window", "mean", "min", "max"]
    assert [line.split()[0] for line in lines if line.startswith("/")] == [
        "/chatter", "/chatter",
    ]  # fmt: skip


@pytest.mark.parametrize("words", [("hz",), ("bw",), ("hz", "/x", "--all")])
def test_names_or_all(words: tuple[str, ...]) -> None:
    with pytest.raises(InvalidValueError, match="or --all"):
        raise navette("topic", *words).exception or AssertionError("it ran")


def test_a_quality_of_service_of_ones_own(talker: Node) -> None:
    publish_each(talker, "chatter", 0.1, lambda _: String())
    seen: list[Any] = []
    talker.create_timer(
        0.35, lambda: seen.extend(talker.get_subscriptions_info_by_topic("chatter"))
    )
    run(talker, "chatter", **RATE, qos=QosOverrides(reliability="reliable"))
    run(talker, "chatter", **RATE)
    first, last = seen[0].qos_profile, seen[-1].qos_profile
    assert first.reliability == ReliabilityPolicy.RELIABLE
    assert last.reliability == ReliabilityPolicy.BEST_EFFORT
    assert (first.depth, last.depth) == (1000, 1000)


def test_hz_of_several_topics_is_a_table(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    publish_each(talker, "a", 0.1, lambda _: String())
    publish_each(talker, "b", 0.25, lambda _: String())
    run(talker, "a", "b", **RATE)
    assert capsys.readouterr().out == (
        "topic   rate     min_delta   max_delta   std_dev   window\n"
        "=========================================================\n"
        "/a      10.000   0.100       0.100       0.00000   8\n"
        "/b      4.000    0.250       0.250       0.00000   2\n\n"
    )


def test_hz_counts_only_messages_that_pass_the_filter(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    publish_each(talker, "n", 0.1, lambda now_ns: Int32(data=now_ns // (100 * MS)))
    run(talker, "n", raw=False, filter="m.data % 5 == 0", count=2, **RATE)
    assert capsys.readouterr().out.startswith("average rate: 2.000\n")


def test_hz_as_json(talker: Node, capsys: pytest.CaptureFixture[str]) -> None:
    publish_each(talker, "chatter", 0.1, lambda _: String())
    run(talker, "chatter", as_json=True, **RATE)
    assert json.loads(capsys.readouterr().out) == {
        "topic": "/chatter",
        "rate_hz": pytest.approx(10.0),
        "mean": pytest.approx(0.1),
        "min": pytest.approx(0.1),
        "max": pytest.approx(0.1),
        "std_dev": pytest.approx(0.0),
        "window": 8,
    }


def test_silence_is_reported_once(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    publisher = talker.create_publisher(String, "chatter", 10)
    clock = talker.get_clock()

    def speak() -> None:
        if not 1.0 < clock.now_ns / 1e9 < 4.0:
            publisher.publish(String())

    talker.create_timer(0.4, speak)
    run(talker, "chatter", count=2, **RATE)
    assert capsys.readouterr().err == "no new messages\n"


def test_bw_as_ros2_prints_it(talker: Node, capsys: pytest.CaptureFixture[str]) -> None:
    size = len(serialize(String(data="x" * 983)))
    assert size == 992
    publish_each(talker, "chatter", 0.1, lambda _: String(data="x" * 983))
    run(talker, "chatter", value=len, make_meter=lambda: LoadMeter(100))
    assert capsys.readouterr().out == (
        "9.92 KB/s from 9 messages\n"
        "\tMessage size mean: 0.99 KB min: 0.99 KB max: 0.99 KB\n"
    )


def test_delay_as_ros2_prints_it(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    def late(now_ns: int) -> Imu:
        stamp: Time = ns_to_stamp(max(0, now_ns - 30 * MS))
        return Imu(header=Header(stamp=stamp))

    publish_each(talker, "imu", 0.1, late)
    run(talker, "imu", **DELAY)
    assert capsys.readouterr().out == (
        "average delay: 0.030\n\tmin: 0.030s max: 0.030s std dev: 0.00000s window: 9\n"
    )


def test_stamps_of_another_clock_are_reported_once(
    talker: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    year_2020 = ns_to_stamp(1_577_836_800 * 10**9)
    publish_each(talker, "imu", 0.1, lambda _: Imu(header=Header(stamp=year_2020)))
    options = {**DELAY, "remark": wrong_clock_remark, "count": 3}
    run(talker, "imu", **options)
    assert capsys.readouterr().err == (
        "the stamps are not set or come from another clock: --wall-time measures in"
        " system time, --use-sim-time in the time of /clock\n"
    )


def test_delay_needs_a_header(talker: Node, capsys: pytest.CaptureFixture[str]) -> None:
    talker.create_publisher(String, "chatter", 10)
    with pytest.raises(click.exceptions.Exit):
        run(talker, "chatter", **DELAY)
    assert "std_msgs/msg/String has no header" in capsys.readouterr().err


def fed(meter: Meter, *stamps_ms: int, value: int = 0) -> Any:
    for stamp in stamps_ms:
        meter.add(stamp * MS, value)
    return meter.figures(stamps_ms[-1] * MS)


def test_a_rate_over_a_window_of_the_newest_intervals() -> None:
    assert fed(RateMeter(2), 0, 1000, 1100, 1300) == Spread(
        pytest.approx(0.15), pytest.approx(0.1), pytest.approx(0.2),
        pytest.approx(0.05), 2,
    )  # fmt: skip


def test_one_message_makes_no_rate() -> None:
    assert fed(RateMeter(10), 5) is None


def test_messages_at_one_instant_make_no_infinite_rate() -> None:
    assert RateMeter.rate_hz(fed(RateMeter(10), 5, 5, 5)) == 0.0


def test_a_jump_back_in_time_resets_the_meters() -> None:
    meter = RateMeter(10)
    assert fed(meter, 100, 200).window == 1
    assert not meter.add(0, 0)
    assert meter.figures(0) is None
    assert meter.add(50 * MS, 0)
    assert meter.figures(50 * MS).mean == pytest.approx(0.05)


def test_figures_come_once_for_the_same_messages() -> None:
    meter = RateMeter(10)
    assert fed(meter, 0, 100) is not None
    assert meter.figures(900 * MS) is None


@pytest.mark.parametrize(
    ("bytes_per_s", "first_line"),
    [
        (999.0, "999 B/s from 3 messages"),
        (1000.0, "1.00 KB/s from 3 messages"),
        (2.5e6, "2.50 MB/s from 3 messages"),
        (0.0, "0 B/s from 3 messages"),
    ],
)
def test_units_of_bandwidth(bytes_per_s: float, first_line: str) -> None:
    load = Load(bytes_per_s, 1.0, 1, 1, 3)
    assert LoadMeter(1).text(load).splitlines()[0] == first_line


def test_delay_is_measured_in_simulated_time_where_asked(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with Context(clock=SystemClock()) as context:
        node = Node("simulator", context=context, start_parameter_services=False)
        Executor(context=context).add_node(node)
        clock = node.create_publisher(Clock, "/clock", 10)
        imu = node.create_publisher(Imu, "imu", 10)

        def tick() -> None:
            clock.publish(Clock(clock=ns_to_stamp(100_000 * MS)))
            imu.publish(Imu(header=Header(stamp=ns_to_stamp(99_750 * MS))))

        node.create_timer(0.01, tick)
        with connect(context) as here:
            assert is_simulated(here)
            follow_clock(here)
            measure(here, MeasureOptions(topics=["imu"], count=1, **DELAY))
    assert capsys.readouterr().out.startswith("average delay: 0.250\n")
