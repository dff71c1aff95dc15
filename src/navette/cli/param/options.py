"""Arguments and options that several verbs of ``navette param`` take."""

from typing import Annotated

from navette.cli.completing import complete_nodes, complete_parameters
from navette.cli.options import Argument, Option

NodeName = Annotated[
    str,
    Argument(
        metavar="NODE", help="Node name, such as /planner.", complete=complete_nodes
    ),
]
AnyNode = Annotated[
    str | None,
    Argument(
        metavar="[NODE]", help="Node name. Default: all nodes.", complete=complete_nodes
    ),
]
Name = Annotated[
    str,
    Argument(
        metavar="NAME",
        help="Parameter name, such as limits.max_speed_mps.",
        complete=complete_parameters,
    ),
]
Names = Annotated[
    list[str],
    Argument(
        metavar="NAME...",
        help="Parameter names.",
        complete=complete_parameters,
    ),
]
Timeout = Annotated[
    float,
    Option("--timeout", min=0, metavar="S", help="Timeout of each response."),
]
