"""The verbs of ``navette topic``; importing them loads neither nodes nor messages."""

from typing import TYPE_CHECKING, Annotated

from navette.cli.commands import Group
from navette.cli.completing import complete_topics
from navette.cli.options import Argument, Json, Option
from navette.cli.output import show, show_json, show_names
from navette.cli.service_calls import note_none
from navette.cli.session import connect, fail, follow_clock, is_simulated
from navette.cli.stderr import note
from navette.cli.topic.echo_options import EchoOptions
from navette.cli.topic.options import (
    Count,
    Filter,
    Hidden,
    JsonLines,
    QosOverrides,
    TopicName,
    TypeName,
)
from navette.cli.topic.pub_options import PublishOptions
from navette.errors import InvalidValueError

if TYPE_CHECKING:
    from navette.cli.topic.meters import Spread

_LONGEST_DELAY_S = 1e7

topic = Group(
    "topic", help="List, inspect, print and measure topics, and publish messages."
)

Window = Annotated[
    int,
    Option("--window", "-w", min=1, metavar="N", help="Use the last N messages."),
]
Prints = Annotated[
    int | None,
    Option("--count", "-n", min=1, metavar="N", help="Stop after N reports."),
]
SimTime = Annotated[
    bool, Option("--use-sim-time", "-s", help="Measure in the time of /clock.")
]
Topics = Annotated[
    list[str] | None,
    Argument(metavar="TOPIC...", help="Topics to measure.", complete=complete_topics),
]
AllTopics = Annotated[
    bool, Option("--all", "-a", help="Measure all topics, including later ones.")
]


@topic.command("list")
def list_(
    show_types: Annotated[
        bool, Option("--show-types", "-t", help="Also print the types.")
    ] = False,
    count_topics: Count = False,
    include_hidden_topics: Hidden = False,
    verbose: Annotated[
        bool, Option("--verbose", "-v", help="Also print types, endpoints and QoS.")
    ] = False,
    as_json: Json = False,
) -> None:
    """List topics."""
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


@topic.command()
def info(
    topic: TopicName,
    verbose: Annotated[
        bool,
        Option("--verbose", "-v", help="Also print node, type and QoS per endpoint."),
    ] = False,
    as_json: Json = False,
) -> None:
    """Show type, publishers, subscriptions and QoS mismatches of a topic."""
    from navette.cli.topic import listing

    with connect() as node:
        found = listing.topic(node, topic)
        if as_json:
            show_json(found.to_json())
        else:
            show(listing.described(found, verbose=verbose))


@topic.command()
def echo(options: EchoOptions) -> None:
    """Print messages of a topic; a latched message is printed at once."""
    from navette.cli.topic.echo import echo

    with connect(node_name=options.node_name) as node:
        echo(node, options)


@topic.command()
def hz(
    topics: Topics = None,
    all_topics: AllTopics = False,
    window: Window = 10000,
    filter_: Filter = None,
    use_sim_time: SimTime = False,
    wall_time: Annotated[
        bool, Option("--wall-time", help="Measure in system time (the default).")
    ] = False,
    count: Prints = None,
    as_json: JsonLines = False,
    *,
    qos: QosOverrides,
) -> None:
    """Measure the rate of messages and its variation."""
    from navette.cli.topic.measuring import MeasureOptions, measure
    from navette.cli.topic.meters import RateMeter

    options = MeasureOptions(
        topics=_wanted(topics, all_topics=all_topics),
        all_topics=all_topics,
        make_meter=lambda: RateMeter(window),
        raw=filter_ is None,
        filter=filter_,
        count=count,
        as_json=as_json,
        qos=qos,
    )
    with connect() as node:
        if use_sim_time and not wall_time:
            follow_clock(node)
        measure(node, options)


@topic.command()
def bw(
    topics: Topics = None,
    all_topics: AllTopics = False,
    window: Window = 100,
    use_sim_time: SimTime = False,
    count: Prints = None,
    as_json: JsonLines = False,
    *,
    qos: QosOverrides,
) -> None:
    """Measure the bandwidth of topics."""
    from navette.cli.topic.measuring import MeasureOptions, measure
    from navette.cli.topic.meters import LoadMeter

    options = MeasureOptions(
        topics=_wanted(topics, all_topics=all_topics),
        all_topics=all_topics,
        make_meter=lambda: LoadMeter(window),
        value=len,
        count=count,
        as_json=as_json,
        qos=qos,
    )
    with connect() as node:
        if use_sim_time:
            follow_clock(node)
        measure(node, options)


def _wanted(topics: list[str] | None, *, all_topics: bool) -> list[str]:
    if bool(topics) == all_topics:
        raise InvalidValueError("give either names of topics or --all")
    return topics or []


@topic.command()
def delay(
    topic: TopicName,
    window: Window = 10000,
    use_sim_time: SimTime = False,
    wall_time: Annotated[
        bool, Option("--wall-time", help="Measure in system time, even with /clock.")
    ] = False,
    count: Prints = None,
    as_json: JsonLines = False,
    *,
    qos: QosOverrides,
) -> None:
    """Measure the delay of messages: arrival time minus header stamp.

    Uses simulated time if /clock is published.
    """
    from navette.cli.topic.measuring import MeasureOptions, measure
    from navette.cli.topic.meters import DelayMeter
    from navette.runtime.time import stamp_to_ns

    options = MeasureOptions(
        topics=[topic],
        make_meter=lambda: DelayMeter(window),
        value=lambda message: stamp_to_ns(message.header.stamp),
        raw=False,
        needs_header=True,
        count=count,
        as_json=as_json,
        qos=qos,
        remark=wrong_clock_remark,
    )
    with connect() as node:
        if use_sim_time or (is_simulated(node) and not wall_time):
            note("measuring in simulated time (/clock)")
            follow_clock(node)
        measure(node, options)


def wrong_clock_remark(figures: "Spread") -> str:
    """Explain a delay of years: the stamps are unset or from another clock."""
    if abs(figures.mean) < _LONGEST_DELAY_S:
        return ""
    return (
        "the stamps are not set or come from another clock: --wall-time measures in"
        " system time, --use-sim-time in the time of /clock"
    )


@topic.command()
def pub(options: PublishOptions) -> None:
    """Publish messages at a rate: until Ctrl-C, or a given number."""
    from navette.cli.topic.publishing import publish

    with connect(node_name=options.node_name) as node:
        publish(node, options)


@topic.command("type")
def type_(topic: TopicName) -> None:
    """Print the type of a topic."""
    from navette.cli.topic import listing

    with connect() as node:
        for each in listing.topic(node, topic).types:
            show(each)


@topic.command()
def find(
    type_name: TypeName,
    count_topics: Count = False,
    include_hidden_topics: Hidden = False,
    as_json: Json = False,
) -> None:
    """List topics of a type."""
    from navette.cli.message_types import if_unknown
    from navette.cli.topic import listing
    from navette.msgs.registry import full_name

    wanted = full_name(type_name)
    with connect() as node:
        every = listing.topics(node, hidden=include_hidden_topics)
    found = [each.name for each in every if wanted in each.types]
    if not (found or count_topics or as_json):
        fail(f"no topic has type {wanted}{if_unknown(wanted)}")
    show_names(found, count=count_topics, as_json=as_json)
