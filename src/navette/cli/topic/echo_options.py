"""Options of ``navette topic echo``."""

from dataclasses import dataclass, field
from typing import Annotated

from navette.cli.completing_installed import complete_messages
from navette.cli.options import Argument, Option
from navette.cli.topic.options import (
    Filter,
    NodeName,
    QosOverrides,
    TopicName,
    complete_fields,
)


@dataclass(frozen=True, kw_only=True)
class Style:
    """How messages are printed. Lengths count items or characters; None: no limit."""

    csv: Annotated[bool, Option("--csv", help="Print comma-separated values.")] = False
    as_json: Annotated[
        bool,
        Option(
            "--json",
            help="Print one line of JSON per message; full arrays, null for NaN.",
        ),
    ] = False
    no_arr: Annotated[
        bool, Option("--no-arr", help="Print only type and length of arrays.")
    ] = False
    no_str: Annotated[
        bool, Option("--no-str", help="Print only the length of strings.")
    ] = False
    flow_style: Annotated[
        bool, Option("--flow-style", help="Print each message on one line.")
    ] = False
    truncate_length: Annotated[
        int | None,
        Option(
            "--truncate-length",
            "-l",
            min=0,
            metavar="N",
            help="Truncate arrays and strings to N items.",
        ),
    ] = 128
    full_length: Annotated[
        bool, Option("--full-length", "-f", help="Print full arrays and strings.")
    ] = False


@dataclass(frozen=True, kw_only=True)
class EchoOptions:
    """What ``topic echo`` prints, and when it stops."""

    topic: TopicName
    type_name: Annotated[
        str | None,
        Argument(
            metavar="TYPE",
            help="Message type. Default: the published type.",
            complete=complete_messages,
        ),
    ] = None
    once: Annotated[bool, Option("--once", help="Stop after one message.")] = False
    count: Annotated[
        int | None,
        Option("--count", "-n", min=1, metavar="N", help="Stop after N messages."),
    ] = None
    timeout_s: Annotated[
        float | None,
        Option("--timeout", min=0, metavar="S", help="Stop after S seconds."),
    ] = None
    paths: Annotated[
        list[str] | None,
        Option(
            "--field",
            metavar="PATH",
            help="Print only this field, as in pose.position.x or ranges[0]. Repeat for"
            " several.",
            complete=complete_fields,
        ),
    ] = None
    filter: Filter = None
    clear: Annotated[
        bool,
        Option("--clear", "-c", help="Clear the screen before each message."),
    ] = False
    style: Style = field(default_factory=Style)
    raw: Annotated[bool, Option("--raw", help="Print the serialized bytes.")] = False
    with_info: Annotated[
        bool,
        Option(
            "--include-message-info",
            "-i",
            help="Also print timestamps and sequence numbers.",
        ),
    ] = False
    no_lost_messages: Annotated[
        bool, Option("--no-lost-messages", help="Do not report lost messages.")
    ] = False
    node_name: NodeName = None
    qos: QosOverrides = field(default_factory=QosOverrides)

    @property
    def limit(self) -> int | None:
        """Number of messages to print; None: until Ctrl-C."""
        return 1 if self.once else self.count
