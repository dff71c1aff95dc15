"""``navette topic hz|bw|delay``: the commands and their options."""

from typing import TYPE_CHECKING, Annotated

import typer

from navette.cli.completing import complete_topics
from navette.cli.output import note
from navette.cli.session import connect, follow_clock, is_simulated
from navette.cli.topic.options import Filter, TopicName
from navette.cli.topic.qos_options import QosWishes
from navette.errors import InvalidValueError

if TYPE_CHECKING:
    from navette.cli.topic.meters import Spread

_LONGEST_DELAY_S = 1e7

Window = Annotated[
    int,
    typer.Option("--window", "-w", min=1, metavar="N", help="Of the last N messages."),
]
Count = Annotated[
    int | None,
    typer.Option("--count", "-n", min=1, metavar="N", help="Print N times and end."),
]
SimTime = Annotated[
    bool,
    typer.Option("--use-sim-time", "-s", help="In the time of /clock."),
]
WallTime = Annotated[
    bool, typer.Option("--wall-time", help="In the machine's time, even with /clock.")
]
Json = Annotated[bool, typer.Option("--json", help="A line of JSON each second.")]


Topics = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="TOPIC...", help="Topics to measure.", autocompletion=complete_topics
    ),
]
AllTopics = Annotated[
    bool, typer.Option("--all", "-a", help="All topics, also those that come later.")
]


def hz(
    topics: Topics = None,
    all_topics: AllTopics = False,
    window: Window = 10000,
    filter_: Filter = None,
    use_sim_time: SimTime = False,
    wall_time: Annotated[
        bool, typer.Option("--wall-time", help="In the machine's time, as always.")
    ] = False,
    count: Count = None,
    as_json: Json = False,
    *,
    qos: QosWishes,
) -> None:
    """Measure how often messages come, and how evenly."""
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


def bw(
    topics: Topics = None,
    all_topics: AllTopics = False,
    window: Window = 100,
    use_sim_time: SimTime = False,
    count: Count = None,
    as_json: Json = False,
    *,
    qos: QosWishes,
) -> None:
    """Measure how many bytes per second topics carry."""
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
        raise InvalidValueError("wanted the names of topics, or --all")
    return topics or []


def of_other_times(figures: "Spread") -> str:
    """Stamps that are years away were never set, or are of another clock."""
    if abs(figures.mean) < _LONGEST_DELAY_S:
        return ""
    return (
        "the stamps are not set, or not in this time: --wall-time measures in the"
        " machine's, --use-sim-time in that of /clock"
    )


def delay(
    topic: TopicName,
    window: Window = 10000,
    use_sim_time: SimTime = False,
    wall_time: WallTime = False,
    count: Count = None,
    as_json: Json = False,
    *,
    qos: QosWishes,
) -> None:
    """Measure how long after their header's stamp messages come.

    In simulated time where somebody publishes /clock.
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
        remark=of_other_times,
    )
    with connect() as node:
        if use_sim_time or (is_simulated(node) and not wall_time):
            note("in simulated time, that of /clock")
            follow_clock(node)
        measure(node, options)
