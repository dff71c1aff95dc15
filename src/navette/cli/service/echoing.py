"""``navette service echo``: the calls of a service, where it tells of them."""

import re
from functools import partial
from typing import Annotated, Any

from navette.cli.message_yaml import yaml_of
from navette.cli.options import Argument, Option
from navette.cli.output import show
from navette.cli.service.looking import types_of
from navette.cli.service.options import ServiceName
from navette.cli.session import connect, service_endpoints, wait_for
from navette.cli.stderr import note

_EVENTS = "/_service_event"


def echo(
    service: ServiceName,
    service_type: Annotated[
        str | None,
        Argument(metavar="[TYPE]", help="By default that of the server."),
    ] = None,
    csv: Annotated[
        bool, Option("--csv", help="Values only, with commas between.")
    ] = False,
    full_length: Annotated[
        bool, Option("--full-length", "-f", help="Shorten nothing.")
    ] = False,
    truncate_length: Annotated[
        int,
        Option(
            "--truncate-length",
            "-l",
            metavar="N",
            min=0,
            help="Shorten arrays and texts to this.",
        ),
    ] = 128,
    no_arr: Annotated[bool, Option("--no-arr", help="No arrays.")] = False,
    no_str: Annotated[bool, Option("--no-str", help="No texts.")] = False,
    flow_style: Annotated[
        bool, Option("--flow-style", help="An event on a line.")
    ] = False,
    once: Annotated[bool, Option("--once", help="End after an event.")] = False,
) -> None:
    """Print requests and responses as they are sent and received.

    The server or the client must tell of them: configure_introspection() in its
    program, or in ROS 2's demo the parameter service_configure_introspection.
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
                f"nobody publishes {name}{_EVENTS}: is service introspection on, at the"
                " server or at a client?"
            )
        wait_for(here, lambda: once and shown > 0)


def _as_csv(event: Any, shortened: dict[str, Any]) -> str:
    from navette.ros2.packages.rosidl_runtime_py import message_to_csv

    return message_to_csv(event, **shortened)


def _as_yaml(event: Any, shortened: dict[str, Any], *, flow_style: bool) -> str:
    """The event, with the kind of event in words."""
    number = event.info.event_type
    text = yaml_of(event, **shortened, flow_style=flow_style)
    # The first field of all: what is said further on stays as it is.
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
