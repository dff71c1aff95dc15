"""What ``topic echo`` is told."""

from dataclasses import dataclass, field
from typing import Annotated

import typer

from navette.cli.completing_installed import complete_messages
from navette.cli.topic.completing_fields import complete_fields
from navette.cli.topic.options import Filter, TopicName
from navette.cli.topic.qos_options import QosWishes
from navette.cli.topic.style import Style


@dataclass(frozen=True, kw_only=True)
class EchoOptions:
    """What to print of a topic."""

    topic: TopicName
    type_name: Annotated[
        str | None,
        typer.Argument(
            metavar="TYPE",
            help="Its type; by default what is published.",
            autocompletion=complete_messages,
        ),
    ] = None
    once: Annotated[bool, typer.Option("--once", help="Print one and end.")] = False
    count: Annotated[
        int | None,
        typer.Option("--count", "-n", min=1, metavar="N", help="Print N and end."),
    ] = None
    timeout_s: Annotated[
        float | None,
        typer.Option("--timeout", min=0.0, metavar="S", help="Wait no longer."),
    ] = None
    paths: Annotated[
        list[str] | None,
        typer.Option(
            "--field",
            metavar="PATH",
            help="Only a part, as in pose.position.x or ranges[0]; repeat for more.",
            autocompletion=complete_fields,
        ),
    ] = None
    filter: Filter = None
    clear: Annotated[
        bool, typer.Option("--clear", "-c", help="Print each over the last one.")
    ] = False
    style: Style = field(default_factory=Style)
    raw: Annotated[bool, typer.Option("--raw", help="The bytes on the wire.")] = False
    with_info: Annotated[
        bool,
        typer.Option("--include-message-info", "-i", help="With stamps and numbers."),
    ] = False
    no_lost_messages: Annotated[
        bool, typer.Option("--no-lost-messages", help="Do not report losses.")
    ] = False
    node_name: Annotated[
        str | None,
        typer.Option("--node-name", metavar="NAME", help="By default a hidden one."),
    ] = None
    qos: QosWishes = field(default_factory=QosWishes)

    @property
    def wanted(self) -> int | None:
        """How many messages; None: until Ctrl-C."""
        return 1 if self.once else self.count
