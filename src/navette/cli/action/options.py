"""Arguments and options that several verbs of ``navette action`` take."""

from typing import Annotated

import typer

from navette.cli.completing import complete_actions
from navette.cli.completing_installed import complete_action_types

ActionName = Annotated[
    str,
    typer.Argument(
        metavar="ACTION",
        help="Name of the action, such as /fibonacci.",
        autocompletion=complete_actions,
    ),
]
ActionType = Annotated[
    str,
    typer.Argument(
        metavar="TYPE",
        help="As example_interfaces/action/Fibonacci.",
        autocompletion=complete_action_types,
    ),
]
Json = Annotated[bool, typer.Option("--json", help="One JSON value, for programs.")]
