"""Arguments and options that several verbs of ``navette param`` take."""

from typing import Annotated

import typer

from navette.cli.completing import complete_nodes, complete_parameters

NodeName = Annotated[
    str,
    typer.Argument(metavar="NODE", help="As /planner.", autocompletion=complete_nodes),
]
AnyNode = Annotated[
    str | None,
    typer.Argument(
        metavar="[NODE]", help="By default every node.", autocompletion=complete_nodes
    ),
]
Name = Annotated[
    str,
    typer.Argument(
        metavar="NAME",
        help="The parameter's name, as limits.max_speed_mps.",
        autocompletion=complete_parameters,
    ),
]
Names = Annotated[
    list[str],
    typer.Argument(
        metavar="NAME...",
        help="The parameters' names.",
        autocompletion=complete_parameters,
    ),
]
Hidden = Annotated[
    bool, typer.Option("--include-hidden-nodes", help="Also nodes named _name.")
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON, for programs.")]
Timeout = Annotated[
    float,
    typer.Option("--timeout", min=0.0, metavar="S", help="Wait so long for answers."),
]
