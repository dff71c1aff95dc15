"""Options that several verbs of ``navette topic`` take."""

from typing import Annotated

import typer

from navette.cli.completing import complete_topics

TopicName = Annotated[
    str,
    typer.Argument(
        metavar="TOPIC",
        help="Name of the topic, such as /chatter.",
        autocompletion=complete_topics,
    ),
]
Hidden = Annotated[
    bool,
    typer.Option(
        "--include-hidden-topics", help="Also those with a part that begins with _."
    ),
]
Json = Annotated[bool, typer.Option("--json", help="One JSON value, for programs.")]
Filter = Annotated[
    str | None,
    typer.Option(
        "--filter",
        metavar="EXPR",
        help="Only messages for which this holds, as in 'm.data > 3' or"
        " 'any(r < 0.5 for r in m.ranges)'.",
    ),
]
