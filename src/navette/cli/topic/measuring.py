"""Listens to topics and prints what a meter makes of it, every second."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import typer

from navette.cli.message_types import topic_class
from navette.cli.nearest import did_you_mean
from navette.cli.output import (
    aligned,
    cut_to_width,
    is_terminal,
    json_text,
    note,
    show,
    styled,
)
from navette.cli.session import endpoints, fail, is_hidden, wait_for
from navette.cli.topic.filtering import message_filter
from navette.cli.topic.meters import Meter
from navette.cli.topic.qos_choice import wished_profile
from navette.cli.topic.qos_options import QosWishes
from navette.msgs import type_name
from navette.msgs.registry import get_message_spec
from navette.runtime import Clock, Node, QoSProfile, ReliabilityPolicy
from navette.runtime.time import ClockType

PERIOD_S = 1.0
# Nothing is asked for twice, and a burst does not count as a slower topic.
_QOS = QoSProfile(depth=1000, reliability=ReliabilityPolicy.BEST_EFFORT)
_HEADER = "std_msgs/msg/Header"


@dataclass(frozen=True, kw_only=True)
class MeasureOptions:
    """What to measure, and how much of it to say."""

    topics: list[str]
    #: Whatever there is, also what comes later.
    all_topics: bool = False
    make_meter: Callable[[], Meter]
    #: What the meter needs of a message (of its bytes, where ``raw``).
    value: Callable[[Any], int] = lambda _: 0
    raw: bool = True
    needs_header: bool = False
    filter: str | None = None
    count: int | None = None
    as_json: bool = False
    qos: QosWishes = field(default_factory=QosWishes)
    #: What to say of unlikely figures, once.
    remark: Callable[[Any], str] = lambda _: ""


def measure(node: Node, options: MeasureOptions) -> None:
    """Print figures every second, until it was often enough."""
    measured = Measured(node, options)
    report = Report(node, measured, options)
    # Of the wall: simulated time may stand.
    clock = Clock(clock_type=ClockType.STEADY_TIME, context=node.context)
    node.create_timer(PERIOD_S, measured.look_for_more, clock=clock)
    node.create_timer(PERIOD_S, report.print, clock=clock)
    wait_for(node, lambda: report.is_full)


class Measured:
    """The topics that are listened to, each with its meter; more may come."""

    def __init__(self, node: Node, options: MeasureOptions) -> None:
        self._node = node
        self._options = options
        self.meters: dict[str, Meter] = {}
        self._unknown: set[str] = set()
        self._missing = [node.resolve_topic_name(name) for name in options.topics]
        self.are_many = options.all_topics or len(self._missing) > 1
        if not self.are_many:
            topic_class(node, self._missing[0])  # waits, and says what is wrong
        self.look_for_more()
        if self._missing:
            every = [each.topic for each in endpoints(node)]
            for name in self._missing:
                note(f"nobody publishes {name} yet{did_you_mean(name, every)}")

    def look_for_more(self) -> None:
        """Listen to those that have come by now."""
        if self._options.all_topics:
            there = {each.topic for each in endpoints(self._node)}
            new = there - set(self.meters) - self._unknown
            names = sorted(name for name in new if not is_hidden(name))
        else:
            names = [name for name in self._missing if endpoints(self._node, name)]
        for name in names:
            meter = self._options.make_meter()
            try:
                _listen(self._node, name, meter, self._options)
            except typer.Exit:  # it has said why
                if not self.are_many:
                    raise
                self._unknown.add(name)
            else:
                self.meters[name] = meter
        done = self._unknown.union(self.meters)
        self._missing = [name for name in self._missing if name not in done]


class Report:
    """Prints the figures of one topic, or a table of those of several."""

    def __init__(self, node: Node, measured: Measured, options: MeasureOptions) -> None:
        self._node = node
        self._measured = measured
        self._options = options
        self._count = 0
        self._lines_above = 0
        self._said_silent = False
        self._remarked = False

    @property
    def is_full(self) -> bool:
        return self._options.count is not None and self._count >= self._options.count

    def print(self) -> None:
        """The figures of what came since the last time, or that nothing came."""
        if self.is_full:
            return
        now_ns = self._node.get_clock().now_ns
        found: dict[str, tuple[Meter, Any]] = {
            topic: (meter, figures)
            for topic, meter in self._measured.meters.items()
            if (figures := meter.figures(now_ns)) is not None
        }
        if not found:
            if not self._said_silent:
                note("no new messages")
            self._said_silent = True
            return
        self._said_silent = False
        self._count += 1
        if self._options.as_json:
            for topic, (meter, figures) in found.items():
                show(json_text({"topic": topic, **meter.to_json(figures)}))
        elif not self._measured.are_many:
            ((meter, figures),) = found.values()
            show(_emphasised(meter.text(figures)))
            remark = self._options.remark(figures)
            if remark and not self._remarked:
                note(remark)
            self._remarked = bool(remark)
        else:
            self._print_table(found)

    def _print_table(self, found: dict[str, tuple[Meter, Any]]) -> None:
        head = next(iter(found.values()))[0].columns
        rows = [(t, *meter.row(figures)) for t, (meter, figures) in found.items()]
        # A line that wraps would be two of those that are written over.
        first, *lines = map(cut_to_width, aligned([("topic", *head), *rows], gap=3))
        width = max(map(len, (first, *lines)))
        text = "\n".join([styled(first, dim=True), "=" * width, *lines, ""])
        if is_terminal() and self._lines_above:
            text = f"\x1b[{self._lines_above}F\x1b[J{text}"
        self._lines_above = len(lines) + 3
        show(text)


def _listen(node: Node, name: str, meter: Meter, options: MeasureOptions) -> None:
    keep = message_filter(options.filter)
    cls = topic_class(node, name)
    topic = node.resolve_topic_name(name)
    if options.needs_header and not _has_header(type_name(cls)):
        fail(f"{topic}: {type_name(cls)} has no header, so no stamp to measure from")

    def receive(message: Any, info: dict[str, int]) -> None:
        if not options.raw and not keep(message):
            return
        now_ns = _arrival_ns(node, info)
        # Simulated time is zero until it has begun.
        if now_ns and not meter.add(now_ns, options.value(message)):
            note("time has reset, resetting counters")

    node.create_subscription(
        cls, topic, receive, _profile(options.qos), raw=options.raw,
        shared=not options.raw,
    )  # fmt: skip


def _profile(wishes: QosWishes) -> QoSProfile:
    if wishes.is_empty:
        return _QOS
    profile = wished_profile(wishes, "sensor_data")
    if wishes.depth is None:
        profile.depth = _QOS.depth
    return profile


def _arrival_ns(node: Node, info: dict[str, int]) -> int:
    if node.get_parameter("use_sim_time").value:
        return node.get_clock().now_ns
    return info["received_timestamp"]


def _has_header(name: str) -> bool:
    fields = get_message_spec(name).fields
    return any(f.name == "header" and f.type.base == _HEADER for f in fields)


def _emphasised(text: str) -> str:
    first, _, rest = text.partition("\n")
    return f"{styled(first, bold=True)}\n{styled(rest, dim=True)}"
