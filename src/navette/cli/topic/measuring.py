"""Subscribe to topics and print the figures of their meters every second."""

import shutil
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import click

from navette.cli.message_types import topic_class
from navette.cli.nearest import did_you_mean
from navette.cli.output import (
    aligned,
    cut_to_width,
    is_terminal,
    json_text,
    show,
    show_over,
    styled,
)
from navette.cli.session import endpoints, fail, is_hidden, wait_for
from navette.cli.stderr import note
from navette.cli.topic.filtering import message_filter
from navette.cli.topic.meters import Meter
from navette.cli.topic.options import QosOverrides
from navette.cli.topic.qos_profiles import overridden_profile
from navette.msgs import type_name
from navette.msgs.registry import get_message_spec
from navette.runtime import Clock, Node, QoSProfile, ReliabilityPolicy
from navette.runtime.time import ClockType

PERIOD_S = 1.0
# Best effort avoids retransmissions; the depth keeps bursts complete.
_QOS = QoSProfile(depth=1000, reliability=ReliabilityPolicy.BEST_EFFORT)
_GAP = 3  # columns between those of the table
_LEAST_NAME = 12  # characters that remain of a topic on a narrow terminal
_OTHER_ROWS = 4  # of the screen: head, rule, empty row, cursor
_HEADER = "std_msgs/msg/Header"


MakeMeter = Callable[[], Meter]
"""Returns the meter of a topic."""

MeterInput = Callable[[Any], int]
"""Returns the input of the meter from a message, or from its bytes if ``raw``."""

Remark = Callable[[Any], str]
"""Returns the explanation of implausible figures, printed once; empty for none."""


@dataclass(frozen=True, kw_only=True)
class MeasureOptions:
    """What to measure, and what to print."""

    topics: list[str]
    all_topics: bool = False
    make_meter: MakeMeter
    value: MeterInput = lambda _: 0
    raw: bool = True
    needs_header: bool = False
    filter: str | None = None
    count: int | None = None
    as_json: bool = False
    qos: QosOverrides = field(default_factory=QosOverrides)
    remark: Remark = lambda _: ""


def measure(node: Node, options: MeasureOptions) -> None:
    """Print figures every second, until the requested number of reports."""
    measured = Measured(node, options)
    report = Report(node, measured, options)
    # Steady time: simulated time can be paused.
    clock = Clock(clock_type=ClockType.STEADY_TIME, context=node.context)
    node.create_timer(PERIOD_S, measured.look_for_more, clock=clock)
    node.create_timer(PERIOD_S, report.print, clock=clock)
    wait_for(node, lambda: report.is_full)


class Measured:
    """Subscribed topics, each with its meter."""

    def __init__(self, node: Node, options: MeasureOptions) -> None:
        self._node = node
        self._options = options
        self.meters: dict[str, Meter] = {}
        self._unknown: set[str] = set()
        self._missing = [node.resolve_topic_name(name) for name in options.topics]
        self.are_many = options.all_topics or len(self._missing) > 1
        if not self.are_many:
            topic_class(node, self._missing[0])  # waits for a publisher
        self.look_for_more()
        if self._missing:
            every = [each.topic for each in endpoints(node)]
            for name in self._missing:
                note(f"no publisher on {name} yet{did_you_mean(name, every)}")

    def look_for_more(self) -> None:
        """Subscribe to topics that appeared since the last call."""
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
            except click.exceptions.Exit:  # the reason was printed
                if not self.are_many:
                    raise
                self._unknown.add(name)
            else:
                self.meters[name] = meter
        done = self._unknown.union(self.meters)
        self._missing = [name for name in self._missing if name not in done]


class Report:
    """Printer of one topic's figures, or of a table of several topics."""

    def __init__(self, node: Node, measured: Measured, options: MeasureOptions) -> None:
        self._node = node
        self._measured = measured
        self._options = options
        self._count = 0
        self._lines_above = 0
        self._noted_silence = False
        self._remarked = False

    @property
    def is_full(self) -> bool:
        return self._options.count is not None and self._count >= self._options.count

    def print(self) -> None:
        """Print the figures since the last call, or that no messages arrived."""
        if self.is_full:
            return
        now_ns = self._node.get_clock().now_ns
        found: dict[str, tuple[Meter, Any]] = {
            topic: (meter, figures)
            for topic, meter in self._measured.meters.items()
            if (figures := meter.figures(now_ns)) is not None
        }
        if not found:
            if not self._noted_silence:
                note("no new messages")
            self._noted_silence = True
            return
        self._noted_silence = False
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
        first, *lines = _table_on_screen([("topic", *head), *rows])
        width = max(map(len, (first, *lines)))
        text = "\n".join([styled(first, dim=True), "=" * width, *lines, ""])
        show_over(text, rows=self._lines_above)
        self._lines_above = len(lines) + 3


def _table_on_screen(rows: list[tuple[str, ...]]) -> list[str]:
    """Format a table that fits the terminal; in a pipe, it has its full size.

    Only lines on the screen can be overwritten: wrapped or scrolled ones would remain.
    """
    if not is_terminal():
        return aligned(rows, gap=_GAP)
    width, height = shutil.get_terminal_size()
    gap = _GAP
    wide = max(map(len, aligned(rows, gap=gap)))
    if wide > width:
        gap = 2
        excess = max(map(len, aligned(rows, gap=gap))) - width
        longest = max(len(topic) for topic, *_ in rows)
        room = max(longest - excess, _LEAST_NAME)
        rows = [(_end_of_name(topic, room), *figures) for topic, *figures in rows]
    lines = [cut_to_width(line) for line in aligned(rows, gap=gap)]
    most = max(height - _OTHER_ROWS, 2)
    if len(lines) - 1 > most:
        left_out = len(lines) - most
        lines = [*lines[:most], cut_to_width(f"… {left_out} more on a taller terminal")]
    return lines


def _end_of_name(topic: str, room: int) -> str:
    """Shorten a name at its start: topics of a node differ in their last part."""
    return topic if len(topic) <= room else f"…{topic[1 - room :]}"


def _listen(node: Node, name: str, meter: Meter, options: MeasureOptions) -> None:
    keep = message_filter(options.filter)
    cls = topic_class(node, name)
    topic = node.resolve_topic_name(name)
    if options.needs_header and not _has_header(type_name(cls)):
        fail(
            f"{topic}: {type_name(cls)} has no header, so its delay cannot be measured"
        )

    def receive(message: Any, info: dict[str, int]) -> None:
        if not options.raw and not keep(message):
            return
        now_ns = _arrival_ns(node, info)
        # Simulated time is zero before the first /clock message.
        if now_ns and not meter.add(now_ns, options.value(message)):
            note("time has reset, resetting counters")

    node.create_subscription(
        cls, topic, receive, _profile(options.qos), raw=options.raw,
        shared=not options.raw,
    )  # fmt: skip


def _profile(overrides: QosOverrides) -> QoSProfile:
    if overrides.is_empty:
        return _QOS
    profile = overridden_profile(overrides, "sensor_data")
    if overrides.depth is None:
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
