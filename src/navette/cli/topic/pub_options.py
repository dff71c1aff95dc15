"""Options of ``navette topic pub``."""

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

from navette.cli.completing import complete_message_values
from navette.cli.options import Argument, Option
from navette.cli.topic.options import QosOverrides, TopicName, TypeName
from navette.errors import InvalidValueError


@dataclass(frozen=True, kw_only=True)
class PublishOptions:
    """What ``topic pub`` publishes, and how often."""

    topic: TopicName
    type_name: TypeName
    values: Annotated[
        str,
        Argument(
            metavar="YAML",
            help="Fields that differ from their defaults, as in"
            " '{linear: {x: 0.5}}'. A header auto and a time now are set to the time of"
            " publishing.",
            complete=complete_message_values,
        ),
    ] = "{}"
    stdin: Annotated[
        bool, Option("--stdin", help="Read the YAML from standard input.")
    ] = False
    yaml_file: Annotated[
        Path | None,
        Option(
            "--yaml-file",
            metavar="FILE",
            help="Publish the messages of a file that topic echo wrote, in order.",
        ),
    ] = None
    rate_hz: Annotated[
        float, Option("--rate", "-r", metavar="HZ", help="Publishing rate.")
    ] = 1.0
    once: Annotated[bool, Option("--once", "-1", help="Publish one message.")] = False
    times: Annotated[
        int,
        Option("--times", "-t", min=0, metavar="N", help="Publish N messages."),
    ] = 0
    wait_for: Annotated[
        int | None,
        Option(
            "--wait-matching-subscriptions",
            "-w",
            min=0,
            metavar="N",
            help="Wait for N matching subscriptions. Default: 1 with --once and"
            " --times, else 0.",
        ),
    ] = None
    max_wait_s: Annotated[
        float | None,
        Option(
            "--max-wait-time-secs",
            min=0,
            metavar="S",
            help="Fail if the subscriptions are not there after S seconds.",
        ),
    ] = None
    print_each: Annotated[
        int,
        Option(
            "--print",
            "-p",
            min=0,
            metavar="N",
            help="Print every N-th message; 0: none.",
        ),
    ] = 1
    keep_alive_s: Annotated[
        float,
        Option(
            "--keep-alive",
            min=0,
            metavar="S",
            help="Wait S seconds after the last message before exiting.",
        ),
    ] = 0.1
    wall_time: Annotated[
        bool,
        Option("--wall-time", help="Stamp with the system time, even with /clock."),
    ] = False
    node_name: Annotated[
        str | None,
        Option(
            "--node-name",
            "-n",
            metavar="NAME",
            help="Name of this node. Default: a hidden name.",
        ),
    ] = None
    qos: QosOverrides = field(default_factory=QosOverrides)

    def __post_init__(self) -> None:
        if not (self.rate_hz > 0 and math.isfinite(self.rate_hz)):
            raise InvalidValueError(
                f"--rate {self.rate_hz!r} is not a finite number above 0 (in Hz)"
            )
        if self.stdin and self.yaml_file is not None:
            raise InvalidValueError("--stdin and --yaml-file cannot be combined")
        if self.once and self.times:
            raise InvalidValueError("--once and --times cannot be combined")
        if self.max_wait_s is not None and not self.subscriptions_wanted:
            raise InvalidValueError(
                "--max-wait-time-secs has no effect without"
                " --wait-matching-subscriptions, --once or --times"
            )

    @property
    def limit(self) -> int:
        """Number of messages to publish; 0: until Ctrl-C."""
        return 1 if self.once else self.times

    @property
    def subscriptions_wanted(self) -> int:
        """Subscriptions to wait for; 1 with ``--once`` or ``--times``, as in ROS 2."""
        return int(self.limit > 0) if self.wait_for is None else self.wait_for
