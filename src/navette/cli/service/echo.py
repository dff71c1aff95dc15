"""``navette service echo``: print the requests and responses of a service."""

import re
from functools import partial
from typing import Annotated, Any

from navette.cli.message_yaml import yaml_of
from navette.cli.options import Argument, Option
from navette.cli.output import show
from navette.cli.service.listing import types_of
from navette.cli.service.options import ServiceName
from navette.cli.session import connect, service_endpoints, wait_for
from navette.cli.stderr import note

_EVENTS = "/_service_event"


def echo(
    service: ServiceName,
    service_type: Annotated[
        str | None,
        Argument(metavar="[TYPE]", help="Service type. Default: that of the server."),
    ] = None,
    csv: Annotated[bool, Option("--csv", help="Print comma-separated values.")] = False,
    full_length: Annotated[
        bool, Option("--full-length", "-f", help="Print full arrays and strings.")
    ] = False,
    truncate_length: Annotated[
        int,
        Option(
            "--truncate-length",
            "-l",
            metavar="N",
            min=0,
            help="Truncate arrays and strings to N items.",
        ),
    ] = 128,
    no_arr: Annotated[bool, Option("--no-arr", help="Do not print arrays.")] = False,
    no_str: Annotated[bool, Option("--no-str", help="Do not print strings.")] = False,
    flow_style: Annotated[
        bool, Option("--flow-style", help="Print each event on one line.")
    ] = False,
    once: Annotated[bool, Option("--once", help="Stop after one event.")] = False,
) -> None:
    """Print requests and responses of a service.

    Needs service introspection in the server or the client: call
    configure_introspection() in its program, or in ROS 2's demo set the parameter
    service_configure_introspection.
    """
    from navette.cli.message_types import interface_class
    from navette.runtime.qos import qos_profile_services_default

    shortened = {
        "truncate_length": None if full_length else truncate_length,
        "no_arr": no_arr,
        "no_str": no_str,
    }
    shown = 0

    def print_event(event: Any) -> None:
        nonlocal shown
        shown += 1
        text = _as_csv if csv else partial(_as_yaml, flow_style=flow_style)
        show(text(event, shortened))

    with connect() as here:
        name = here.resolve_service_name(service)
        chosen = service_type or types_of(here, name)[0]
        kind = interface_class(here, chosen, service_endpoints(here), kind="srv")
        subscription = here.create_subscription(
            kind.Event, name + _EVENTS, print_event, qos_profile_services_default
        )
        if not subscription.get_publisher_count():
            note(
                f"no publisher on {name}{_EVENTS}: enable service introspection in the"
                " server or a client"
            )
        wait_for(here, lambda: once and shown > 0)


def _as_csv(event: Any, shortened: dict[str, Any]) -> str:
    from navette.ros2.packages.rosidl_runtime_py import message_to_csv

    return message_to_csv(event, **shortened)


def _as_yaml(event: Any, shortened: dict[str, Any], *, flow_style: bool) -> str:
    """Format the event, with the name of its kind instead of the number."""
    number = event.info.event_type
    text = yaml_of(event, **shortened, flow_style=flow_style)
    # Only the first match is the event's own field.
    word = _event_words().get(number, number)
    return (
        re.sub(rf"(event_type\S*: ){number}\b", rf"\g<1>{word}", text, count=1) + "---"
    )


def _event_words() -> dict[int, str]:
    from navette.msgs.service_msgs.msg import ServiceEventInfo

    words = (
        "REQUEST_SENT",
        "REQUEST_RECEIVED",
        "RESPONSE_SENT",
        "RESPONSE_RECEIVED",
    )
    return {getattr(ServiceEventInfo, word): word for word in words}
