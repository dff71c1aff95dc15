"""Options that several verbs of ``navette topic`` take."""

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import click

from navette.cli.completing import complete_topics, running
from navette.cli.completing_installed import chosen, complete_from, complete_messages
from navette.cli.options import Argument, Option
from navette.cli.session import endpoints
from navette.errors import NavetteError

if TYPE_CHECKING:
    from navette.runtime import Node

QOS_PANEL = "Quality of service"
# ROS 2's names; spelled out so that declaring the options imports nothing.
QOS_PROFILES = (
    "unknown",
    "default",
    "system_default",
    "sensor_data",
    "services_default",
    "parameters",
    "parameter_events",
    "action_status_default",
    "best_available",
)

TopicName = Annotated[
    str,
    Argument(
        metavar="TOPIC",
        help="Name of the topic, such as /chatter.",
        complete=complete_topics,
    ),
]
TypeName = Annotated[
    str,
    Argument(
        metavar="TYPE",
        help="Message type, such as std_msgs/msg/String.",
        complete=complete_messages,
    ),
]
Hidden = Annotated[
    bool,
    Option(
        "--include-hidden-topics",
        help="Include hidden topics: a part of the name begins with _.",
    ),
]
Count = Annotated[
    bool, Option("--count-topics", "-c", "--count", help="Print only the number.")
]
JsonLines = Annotated[bool, Option("--json", help="Print one line of JSON each time.")]
Filter = Annotated[
    str | None,
    Option(
        "--filter",
        metavar="EXPR",
        help="Only messages for which the expression is true, as in 'm.data > 3' or"
        " 'any(r < 0.5 for r in m.ranges)'.",
    ),
]
NodeName = Annotated[
    str | None,
    Option(
        "--node-name", metavar="NAME", help="Name of this node. Default: a hidden name."
    ),
]


def _qos(policy: str, *values: str) -> Option:
    """Return the option of a policy with a fixed set of values."""
    return Option(
        f"--qos-{policy}",
        help=f"{', '.join(values[:-1])} or {values[-1]}.",
        complete=complete_from(*values),
        panel=QOS_PANEL,
    )


@dataclass(frozen=True, kw_only=True)
class QosOverrides:
    """Policies given with ``--qos-…``; None means not given."""

    profile: Annotated[str | None, _qos("profile", *QOS_PROFILES)] = None
    depth: Annotated[
        int | None,
        Option("--qos-depth", min=0, metavar="N", help="Queue size.", panel=QOS_PANEL),
    ] = None
    history: Annotated[str | None, _qos("history", "keep_last", "keep_all")] = None
    reliability: Annotated[
        str | None, _qos("reliability", "reliable", "best_effort")
    ] = None
    durability: Annotated[
        str | None, _qos("durability", "volatile", "transient_local")
    ] = None
    liveliness: Annotated[
        str | None, _qos("liveliness", "automatic", "manual_by_topic")
    ] = None
    lease_s: Annotated[
        float | None,
        Option(
            "--qos-liveliness-lease-duration-seconds",
            metavar="S",
            help="Liveliness lease duration.",
            panel=QOS_PANEL,
        ),
    ] = None

    @property
    def is_empty(self) -> bool:
        return self == QosOverrides()


def complete_fields(ctx: click.Context, incomplete: str) -> list[str]:
    """Complete a path to a field of the topic's messages, two levels deep."""
    from navette.cli.message_types import full_type_name, installed_class
    from navette.msgs import type_name
    from navette.msgs.field_path import field_paths

    def published_types(here: "Node") -> Iterable[str]:
        topic = here.resolve_topic_name(str(ctx.params.get("topic") or ""))
        return (end.type_name for end in endpoints(here, topic))

    given = str(ctx.params.get("type_name") or "")
    for name in [given] if given else running("", published_types):
        with suppress(NavetteError):
            cls = installed_class(full_type_name(name, "msg"))
            if cls is not None:
                return chosen(incomplete, field_paths(incomplete, type_name(cls)))
    return []
