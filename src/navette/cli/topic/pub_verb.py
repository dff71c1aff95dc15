"""``navette topic pub``: the command and its options."""

from typing import Annotated

import typer

from navette.cli.completing import complete_message_values, complete_messages
from navette.cli.session import connect
from navette.cli.topic import qos_options
from navette.cli.topic.options import TopicName
from navette.errors import InvalidValueError


def pub(
    topic: TopicName,
    type_name: Annotated[
        str,
        typer.Argument(
            metavar="TYPE",
            help="Its type, such as std_msgs/msg/String.",
            autocompletion=complete_messages,
        ),
    ],
    values: Annotated[
        str,
        typer.Argument(
            metavar="YAML",
            help="Fields that are not at their defaults, as in '{linear: {x: 0.5}}';"
            " auto for a header and now for a time mean when it is sent.",
            autocompletion=complete_message_values,
        ),
    ] = "{}",
    stdin: Annotated[
        bool, typer.Option("--stdin", help="Read the YAML from standard input.")
    ] = False,
    rate: Annotated[
        float, typer.Option("--rate", "-r", metavar="HZ", help="How often.")
    ] = 1.0,
    once: Annotated[bool, typer.Option("--once", "-1", help="Once, and end.")] = False,
    times: Annotated[
        int, typer.Option("--times", "-t", min=0, metavar="N", help="N times, and end.")
    ] = 0,
    wait_matching_subscriptions: Annotated[
        int | None,
        typer.Option(
            "--wait-matching-subscriptions",
            "-w",
            min=0,
            metavar="N",
            help="Begin when N hear it; by default 1 with --once and --times, else 0.",
        ),
    ] = None,
    max_wait_time_secs: Annotated[
        float | None,
        typer.Option(min=0.0, metavar="S", help="Wait for them no longer than this."),
    ] = None,
    print_: Annotated[
        int,
        typer.Option(
            "--print", "-p", min=0, metavar="N", help="Print every N-th; 0: none."
        ),
    ] = 1,
    keep_alive: Annotated[
        float, typer.Option(min=0.0, metavar="S", help="Stay so long after the last.")
    ] = 0.1,
    wall_time: Annotated[
        bool,
        typer.Option("--wall-time", help="Stamp in the machine's time always."),
    ] = False,
    node_name: Annotated[
        str | None,
        typer.Option(
            "--node-name", "-n", metavar="NAME", help="By default a hidden one."
        ),
    ] = None,
    qos_profile: qos_options.Profile = None,
    qos_depth: qos_options.Depth = None,
    qos_history: qos_options.History = None,
    qos_reliability: qos_options.Reliability = None,
    qos_durability: qos_options.Durability = None,
    qos_liveliness: qos_options.Liveliness = None,
    qos_lease: qos_options.Lease = None,
) -> None:
    """Publish a message, at a rate until Ctrl-C, or as often as you say."""
    from navette.cli.filling import from_stdin
    from navette.cli.topic.publishing import PublishOptions, publish

    if not 0 < rate < float("inf"):
        raise InvalidValueError(f"--rate {rate!r}: wanted a number above 0, in Hz")
    if once and times:
        raise InvalidValueError("--once and --times: wanted one of them")
    options = PublishOptions(
        topic=topic,
        type_name=type_name,
        values=from_stdin() if stdin else values,
        rate_hz=rate,
        times=1 if once else times,
        print_each=print_,
        wait_for=wait_matching_subscriptions,
        max_wait_s=max_wait_time_secs,
        keep_alive_s=keep_alive,
        wall_time=wall_time,
        qos=qos_options.QosWishes(
            profile=qos_profile,
            depth=qos_depth,
            history=qos_history,
            reliability=qos_reliability,
            durability=qos_durability,
            liveliness=qos_liveliness,
            lease_s=qos_lease,
        ),
    )
    with connect(node_name=node_name) as node:
        publish(node, options)
