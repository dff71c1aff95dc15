"""What ``topic pub`` is told."""

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

import typer

from navette.cli.completing import complete_message_values
from navette.cli.completing_installed import complete_messages
from navette.cli.topic.options import TopicName
from navette.cli.topic.qos_options import QosWishes
from navette.errors import InvalidValueError


@dataclass(frozen=True, kw_only=True)
class PublishOptions:
    """What to publish, and how often."""

    topic: TopicName
    type_name: Annotated[
        str,
        typer.Argument(
            metavar="TYPE",
            help="Its type, such as std_msgs/msg/String.",
            autocompletion=complete_messages,
        ),
    ]
    values: Annotated[
        str,
        typer.Argument(
            metavar="YAML",
            help="Fields that are not at their defaults, as in '{linear: {x: 0.5}}';"
            " auto for a header and now for a time mean when it is sent.",
            autocompletion=complete_message_values,
        ),
    ] = "{}"
    stdin: Annotated[
        bool, typer.Option("--stdin", help="Read the YAML from standard input.")
    ] = False
    yaml_file: Annotated[
        Path | None,
        typer.Option(
            "--yaml-file",
            metavar="FILE",
            help="Publish what topic echo wrote there: one message after the other.",
        ),
    ] = None
    rate_hz: Annotated[
        float, typer.Option("--rate", "-r", metavar="HZ", help="How often.")
    ] = 1.0
    once: Annotated[bool, typer.Option("--once", "-1", help="Once, and end.")] = False
    times: Annotated[
        int, typer.Option("--times", "-t", min=0, metavar="N", help="N times, and end.")
    ] = 0
    wait_for: Annotated[
        int | None,
        typer.Option(
            "--wait-matching-subscriptions",
            "-w",
            min=0,
            metavar="N",
            help="Begin when N hear it; by default 1 with --once and --times, else 0.",
        ),
    ] = None
    max_wait_s: Annotated[
        float | None,
        typer.Option(
            "--max-wait-time-secs", min=0.0, metavar="S", help="Wait no longer."
        ),
    ] = None
    print_each: Annotated[
        int,
        typer.Option(
            "--print", "-p", min=0, metavar="N", help="Print every N-th; 0: none."
        ),
    ] = 1
    keep_alive_s: Annotated[
        float,
        typer.Option(
            "--keep-alive", min=0.0, metavar="S", help="Stay so long after the last."
        ),
    ] = 0.1
    wall_time: Annotated[
        bool,
        typer.Option("--wall-time", help="Stamp in the machine's time always."),
    ] = False
    node_name: Annotated[
        str | None,
        typer.Option(
            "--node-name", "-n", metavar="NAME", help="By default a hidden one."
        ),
    ] = None
    qos: QosWishes = field(default_factory=QosWishes)

    def __post_init__(self) -> None:
        if not (self.rate_hz > 0 and math.isfinite(self.rate_hz)):
            raise InvalidValueError(
                f"--rate {self.rate_hz!r}: wanted a number above 0, in Hz"
            )
        if self.stdin and self.yaml_file is not None:
            raise InvalidValueError("--stdin and --yaml-file: wanted one of them")
        if self.once and self.times:
            raise InvalidValueError("--once and --times: wanted one of them")
        if self.max_wait_s is not None and not self.subscriptions_wanted:
            raise InvalidValueError(
                "--max-wait-time-secs: nothing is waited for without"
                " --wait-matching-subscriptions, --once or --times"
            )

    @property
    def wanted(self) -> int:
        """How often; 0: until Ctrl-C."""
        return 1 if self.once else self.times

    @property
    def subscriptions_wanted(self) -> int:
        """As in ROS 2: a message that is sent once should have a hearer."""
        return int(self.wanted > 0) if self.wait_for is None else self.wait_for
