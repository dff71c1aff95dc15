"""Arguments and options that several verbs of ``navette service`` take."""

from typing import Annotated

from navette.cli.completing import complete_services
from navette.cli.completing_installed import complete_service_types
from navette.cli.options import Argument, Option

ServiceName = Annotated[
    str,
    Argument(
        metavar="SERVICE",
        help="Name of the service, such as /add_two_ints.",
        complete=complete_services,
    ),
]
ServiceType = Annotated[
    str,
    Argument(
        metavar="TYPE",
        help="As std_srvs/srv/SetBool.",
        complete=complete_service_types,
    ),
]
Hidden = Annotated[
    bool,
    Option(
        "--include-hidden-services",
        "-a",
        help="Also those with a part that begins with _.",
    ),
]
Json = Annotated[bool, Option("--json", help="One JSON value, for programs.")]
