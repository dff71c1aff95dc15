"""Arguments and options that several verbs of ``navette action`` take."""

from typing import Annotated

from navette.cli.completing import complete_actions
from navette.cli.completing_installed import complete_action_types
from navette.cli.options import Argument

ActionName = Annotated[
    str,
    Argument(
        metavar="ACTION",
        help="Name of the action, such as /fibonacci.",
        complete=complete_actions,
    ),
]
ActionType = Annotated[
    str,
    Argument(
        metavar="TYPE",
        help="Action type, such as example_interfaces/action/Fibonacci.",
        complete=complete_action_types,
    ),
]
