"""Arguments and options that several verbs of ``navette param`` take."""

from typing import Annotated

from navette.cli.completing import complete_nodes, complete_parameters
from navette.cli.options import Argument, Option

NodeName = Annotated[
    str,
    Argument(metavar="NODE", help="As /planner.", complete=complete_nodes),
]
AnyNode = Annotated[
    str | None,
    Argument(metavar="[NODE]", help="By default every node.", complete=complete_nodes),
]
Name = Annotated[
    str,
    Argument(
        metavar="NAME",
        help="The parameter's name, as limits.max_speed_mps.",
        complete=complete_parameters,
    ),
]
Names = Annotated[
    list[str],
    Argument(
        metavar="NAME...",
        help="The parameters' names.",
        complete=complete_parameters,
    ),
]
Hidden = Annotated[
    bool, Option("--include-hidden-nodes", help="Also nodes named _name.")
]
Json = Annotated[bool, Option("--json", help="Print JSON, for programs.")]
Timeout = Annotated[
    float,
    Option("--timeout", min=0.0, metavar="S", help="Wait so long for answers."),
]
