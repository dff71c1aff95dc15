"""Print the messages of a topic."""

import re
import shutil
from collections.abc import Sequence
from typing import Any

import yaml

from navette.cli.message_types import topic_class
from navette.cli.output import is_terminal, show, show_over
from navette.cli.session import endpoints, fail, wait_for
from navette.cli.stderr import note
from navette.cli.topic.echo_options import EchoOptions
from navette.cli.topic.filtering import message_filter
from navette.cli.topic.options import QosOverrides
from navette.cli.topic.printing import SEPARATOR, text_of
from navette.cli.topic.qos_profiles import compatible_profile, overridden_profile
from navette.msgs import type_name
from navette.msgs.field_path import FieldPath, parse_field_path
from navette.runtime import Node, QoSProfile
from navette.runtime.qos_events import SubscriptionEventCallbacks
from navette.transports import EndpointKind

_COLOUR = re.compile(r"\x1b\[[\d;]*m")


def echo(node: Node, options: EchoOptions) -> None:
    """Print messages until the count or the timeout is reached.

    The command fails if the timeout passes before the requested messages arrive.
    """
    keep = message_filter(options.filter)
    deadline_ns = None
    if options.timeout_s is not None:
        deadline_ns = node.context.clock.now_ns + round(options.timeout_s * 1e9)
    cls = topic_class(node, options.topic, options.type_name, options.timeout_s)
    name = type_name(cls)
    screen = Screen(options, [parse_field_path(p, name) for p in options.paths or ()])

    def receive(message: Any, info: dict[str, Any]) -> None:
        if options.raw or keep(message):
            screen.show(message, info)

    topic = node.resolve_topic_name(options.topic)
    events = SubscriptionEventCallbacks(
        message_lost=None if options.no_lost_messages else _report_lost
    )
    node.create_subscription(
        cls, topic, receive, _profile(node, topic, options.qos), raw=options.raw,
        event_callbacks=events, shared=True,
    )  # fmt: skip
    left_s = None
    if deadline_ns is not None:
        left_s = max(0.0, (deadline_ns - node.context.clock.now_ns) / 1e9)
    enough = wait_for(node, lambda: screen.is_full, left_s)
    if not enough and (options.limit is not None or not screen.count):
        fail(f"messages received on {topic}: {screen.count} in {options.timeout_s:g} s")


class Screen:
    """Printer that counts messages and, with ``--clear``, overwrites the last one."""

    def __init__(self, options: EchoOptions, paths: Sequence[FieldPath]) -> None:
        self._options = options
        self._paths = paths
        self._style = options.style
        self._noted_short = False
        self._clears = options.clear and is_terminal()
        self.count = 0

    @property
    def is_full(self) -> bool:
        limit = self._options.limit
        return limit is not None and self.count >= limit

    def show(self, message: Any, info: dict[str, Any]) -> None:
        if self.is_full:
            return
        text = self._text(message)
        if text is None:
            return
        self.count += 1
        if self._options.with_info:
            text = self._with_info(text, info)
        if self._clears:
            show_over(_cut_to_screen(text), clear=self.count == 1)
        else:
            show(text)

    def _text(self, message: Any) -> str | None:
        if self._options.raw:
            return f"{message!r}\n{SEPARATOR}"
        try:
            parts = [(path, path.of(message)) for path in self._paths]
        except IndexError:
            if not self._noted_short:
                names = ", ".join(path.text for path in self._paths)
                note(f"{names}: skipping messages whose arrays are too short")
            self._noted_short = True
            return None
        return text_of(message, parts, self._style)

    def _with_info(self, text: str, info: dict[str, Any]) -> str:
        if self._style.csv:
            return f"{','.join(str(value) for value in info.values())},{text}"
        return f"{yaml.safe_dump(info)}{SEPARATOR}\n{text}"


def _cut_to_screen(text: str) -> str:
    """Cut the text to the terminal's height: a scrolled text cannot be overwritten."""
    width, height = shutil.get_terminal_size()
    lines = text.split("\n")
    rows = 0
    for number, line in enumerate(lines):
        rows += 1 + max(0, len(_COLOUR.sub("", line)) - 1) // width
        if rows >= height - 1 and number < len(lines) - 1:
            return "\n".join([*lines[:number], "…"])
    return text


def _profile(node: Node, topic: str, overrides: QosOverrides) -> QoSProfile:
    if not overrides.is_empty:
        return overridden_profile(overrides, "sensor_data")
    return compatible_profile(endpoints(node, topic, kind=EndpointKind.PUBLISHER))


def _report_lost(event: Any) -> None:
    note(f"messages lost: {event.total_count_change} ({event.total_count} in total)")
