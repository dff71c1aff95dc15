"""Options that several verbs of ``navette topic`` take."""

from typing import Annotated

import typer

TopicName = Annotated[
    str, typer.Argument(metavar="TOPIC", help="Name of the topic, such as /chatter.")
]
Hidden = Annotated[
    bool,
    typer.Option(
        "--include-hidden-topics", help="Also those with a part that begins with _."
    ),
]
Json = Annotated[bool, typer.Option("--json", help="One JSON value, for programs.")]
