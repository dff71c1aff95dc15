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
        help="Service type, such as std_srvs/srv/SetBool.",
        complete=complete_service_types,
    ),
]
Hidden = Annotated[
    bool,
    Option(
        "--include-hidden-services",
        "-a",
        help="Include hidden services (a part of the name begins with _) and, on a"
        " terminal, those of every node.",
    ),
]
