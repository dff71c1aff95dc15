"""``navette topic echo``: the command and its options."""

from typing import Annotated

import typer

from navette.cli.completing import complete_messages
from navette.cli.session import connect
from navette.cli.topic import qos_options
from navette.cli.topic.options import Filter, TopicName

TypeName = Annotated[
    str | None,
    typer.Argument(
        metavar="TYPE",
        help="Its type; by default what is published.",
        autocompletion=complete_messages,
    ),
]


def echo(
    topic: TopicName,
    type_name: TypeName = None,
    once: Annotated[bool, typer.Option("--once", help="Print one and end.")] = False,
    count: Annotated[
        int | None,
        typer.Option("--count", "-n", min=1, metavar="N", help="Print N and end."),
    ] = None,
    timeout: Annotated[
        float | None,
        typer.Option(min=0.0, metavar="S", help="Wait no longer than this."),
    ] = None,
    field: Annotated[
        str | None,
        typer.Option(
            metavar="PATH", help="Only a part, as in pose.position.x or ranges[0]."
        ),
    ] = None,
    filter_: Filter = None,
    clear: Annotated[
        bool, typer.Option("--clear", "-c", help="Print each over the last one.")
    ] = False,
    csv: Annotated[
        bool, typer.Option("--csv", help="A line of values with commas between.")
    ] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="A line of JSON each, arrays whole.")
    ] = False,
    raw: Annotated[bool, typer.Option("--raw", help="The bytes on the wire.")] = False,
    no_arr: Annotated[
        bool, typer.Option("--no-arr", help="Arrays only by type and length.")
    ] = False,
    no_str: Annotated[
        bool, typer.Option("--no-str", help="Texts only by length.")
    ] = False,
    flow_style: Annotated[
        bool, typer.Option("--flow-style", help="Each message on one line.")
    ] = False,
    truncate_length: Annotated[
        int,
        typer.Option(
            "--truncate-length",
            "-l",
            min=0,
            metavar="N",
            help="Items shown of arrays and texts.",
        ),
    ] = 128,
    full_length: Annotated[
        bool, typer.Option("--full-length", "-f", help="Arrays and texts whole.")
    ] = False,
    include_message_info: Annotated[
        bool,
        typer.Option("--include-message-info", "-i", help="With stamps and numbers."),
    ] = False,
    no_lost_messages: Annotated[
        bool, typer.Option("--no-lost-messages", help="Do not report losses.")
    ] = False,
    node_name: Annotated[
        str | None, typer.Option(metavar="NAME", help="By default a hidden one.")
    ] = None,
    qos_profile: qos_options.Profile = None,
    qos_depth: qos_options.Depth = None,
    qos_history: qos_options.History = None,
    qos_reliability: qos_options.Reliability = None,
    qos_durability: qos_options.Durability = None,
    qos_liveliness: qos_options.Liveliness = None,
    qos_lease: qos_options.Lease = None,
) -> None:
    """Print what is published on a topic; the last of a latched one at once."""
    from navette.cli.topic.echo import EchoOptions
    from navette.cli.topic.echo import echo as print_messages
    from navette.cli.topic.printing import Style

    options = EchoOptions(
        topic=topic,
        type_name=type_name,
        path=field,
        filter=filter_,
        raw=raw,
        count=1 if once else count,
        timeout_s=timeout,
        with_info=include_message_info,
        clear=clear,
        report_lost=not no_lost_messages,
        style=Style(
            csv=csv,
            as_json=as_json,
            truncate_length=None if full_length else truncate_length,
            no_arr=no_arr,
            no_str=no_str,
            flow_style=flow_style,
        ),
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
        print_messages(node, options)
