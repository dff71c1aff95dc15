"""Arguments and options that several verbs of ``navette service`` take."""

from typing import Annotated

import typer

from navette.cli.completing import complete_services
from navette.cli.completing_installed import complete_service_types

ServiceName = Annotated[
    str,
    typer.Argument(
        metavar="SERVICE",
        help="Name of the service, such as /add_two_ints.",
        autocompletion=complete_services,
    ),
]
ServiceType = Annotated[
    str,
    typer.Argument(
        metavar="TYPE",
        help="As std_srvs/srv/SetBool.",
        autocompletion=complete_service_types,
    ),
]
Hidden = Annotated[
    bool,
    typer.Option(
        "--include-hidden-services",
        "-a",
        help="Also those with a part that begins with _.",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="One JSON value, for programs.")]
