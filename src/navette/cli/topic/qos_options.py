"""``--qos-…``: the quality of service that a verb is told, or takes as it fits."""

from dataclasses import dataclass
from typing import Annotated

import typer

from navette.cli.completing_installed import complete_from

PANEL = "Quality of service"

# The words are ROS 2's; spelt out, so that the command line's start imports nothing.
PROFILES = (
    "unknown default system_default sensor_data services_default parameters "
    "parameter_events action_status_default best_available"
)
Profile = Annotated[
    str | None,
    typer.Option(
        "--qos-profile",
        help=f"One of: {PROFILES}.",
        autocompletion=complete_from(*PROFILES.split()),
        rich_help_panel=PANEL,
    ),
]
Depth = Annotated[
    int | None,
    typer.Option(
        "--qos-depth", min=0, metavar="N", help="Queue length.", rich_help_panel=PANEL
    ),
]
History = Annotated[
    str | None,
    typer.Option(
        "--qos-history",
        help="keep_last or keep_all.",
        autocompletion=complete_from("keep_last", "keep_all"),
        rich_help_panel=PANEL,
    ),
]
Reliability = Annotated[
    str | None,
    typer.Option(
        "--qos-reliability",
        help="reliable or best_effort.",
        autocompletion=complete_from("reliable", "best_effort"),
        rich_help_panel=PANEL,
    ),
]
Durability = Annotated[
    str | None,
    typer.Option(
        "--qos-durability",
        help="volatile or transient_local.",
        autocompletion=complete_from("volatile", "transient_local"),
        rich_help_panel=PANEL,
    ),
]
Liveliness = Annotated[
    str | None,
    typer.Option(
        "--qos-liveliness",
        help="automatic or manual_by_topic.",
        autocompletion=complete_from("automatic", "manual_by_topic"),
        rich_help_panel=PANEL,
    ),
]
Lease = Annotated[
    float | None,
    typer.Option(
        "--qos-liveliness-lease-duration-seconds",
        metavar="S",
        help="How long a sign of life counts.",
        rich_help_panel=PANEL,
    ),
]


@dataclass(frozen=True, kw_only=True)
class QosWishes:
    """What was said with ``--qos-…``; None = nothing."""

    profile: Profile = None
    depth: Depth = None
    history: History = None
    reliability: Reliability = None
    durability: Durability = None
    liveliness: Liveliness = None
    lease_s: Lease = None

    @property
    def is_empty(self) -> bool:
        return self == QosWishes()
