"""``navette topic list|info|type|find``: commands that look once."""

from typing import Annotated

import typer

from navette.cli.asking import note_none
from navette.cli.completing_installed import complete_messages
from navette.cli.output import show, show_json
from navette.cli.session import connect, fail
from navette.cli.topic.options import Hidden, Json, TopicName


def list_(
    show_types: Annotated[
        bool, typer.Option("--show-types", "-t", help="With the types.")
    ] = False,
    count_topics: Annotated[
        bool, typer.Option("--count-topics", "-c", "--count", help="Only how many.")
    ] = False,
    include_hidden_topics: Hidden = False,
    verbose: Annotated[
        bool,
        typer.Option("--verbose", "-v", help="With types, endpoints and their QoS."),
    ] = False,
    as_json: Json = False,
) -> None:
    """List the topics of all that runs."""
    from navette.cli.topic import listing

    with connect() as node:
        found = listing.topics(node, hidden=include_hidden_topics)
        if not (found or count_topics or as_json):
            note_none(node, "topics")
    if count_topics:
        show(str(len(found)))
    elif as_json:
        show_json([each.to_json() for each in found])
    elif found:
        show(listing.listed(found, show_types=show_types, verbose=verbose))


def info(
    topic: TopicName,
    verbose: Annotated[
        bool, typer.Option("--verbose", "-v", help="Each endpoint: node, type, QoS.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Show a topic's type, its publishers and subscriptions, and which do not fit."""
    from navette.cli.topic import listing

    with connect() as node:
        found = listing.topic(node, topic)
        if as_json:
            show_json(found.to_json())
        else:
            show(listing.described(found, verbose=verbose))


def type_(topic: TopicName) -> None:
    """Print a topic's type."""
    from navette.cli.topic import listing

    with connect() as node:
        for each in listing.topic(node, topic).types:
            show(each)


def find(
    type_name: Annotated[
        str,
        typer.Argument(
            metavar="TYPE",
            help="A message type: pkg/msg/Name.",
            autocompletion=complete_messages,
        ),
    ],
    count_topics: Annotated[
        bool, typer.Option("--count-topics", "-c", "--count", help="Only how many.")
    ] = False,
    include_hidden_topics: Hidden = False,
    as_json: Json = False,
) -> None:
    """List the topics that carry a type."""
    from navette.cli.message_types import if_unknown
    from navette.cli.topic import listing
    from navette.msgs.registry import full_name

    wanted = full_name(type_name)
    with connect() as node:
        every = listing.topics(node, hidden=include_hidden_topics)
    found = [each.name for each in every if wanted in each.types]
    if count_topics:
        show(str(len(found)))
    elif as_json:
        show_json(found)
    elif found:
        show("\n".join(found))
    else:
        fail(f"no topic carries {wanted}{if_unknown(wanted)}")
