"""``navette service call``: send a request given as YAML and print the response."""

from typing import TYPE_CHECKING, Annotated, Any

from navette.cli.completing import complete_request
from navette.cli.nearest import did_you_mean
from navette.cli.options import Argument, Json, Option, Stdin
from navette.cli.output import show, show_json, styled
from navette.cli.request_builder import filled, from_stdin, type_and_values
from navette.cli.service.listing import services, types_of
from navette.cli.service.options import ServiceName
from navette.cli.session import connect, fail, service_endpoints, wait_for
from navette.cli.stderr import note
from navette.errors import InvalidValueError

if TYPE_CHECKING:
    from navette.runtime import Client, Node


def call(
    service: ServiceName,
    words: Annotated[
        list[str] | None,
        Argument(
            metavar="[TYPE] [YAML]",
            help="Service type (default: that of the server), and the request fields"
            " that differ from their defaults: '{a: 1, b: 2}'.",
            complete=complete_request,
        ),
    ] = None,
    rate: Annotated[
        float | None,
        Option("--rate", "-r", metavar="HZ", help="Call repeatedly at this rate."),
    ] = None,
    timeout: Annotated[
        float,
        Option("--timeout", "-w", metavar="S", help="Fail after S seconds; 0: never."),
    ] = 5.0,
    stdin: Stdin = False,
    as_json: Json = False,
) -> None:
    """Call a service and print its response.

    Exit code 1: the server does not exist, or the call failed.
    """
    from navette.cli.message_types import interface_class

    if rate is not None and not rate > 0:
        raise InvalidValueError(f"--rate {rate:g} is not above 0 (in Hz)")
    type_name, values = type_and_values(words or [], "srv")
    if stdin:
        values = from_stdin()
    timeout_s = timeout or None
    with connect() as here:
        name = here.resolve_service_name(service)
        _wait_for_server(here, name, timeout_s)
        chosen = type_name or types_of(here, name)[0]
        kind = interface_class(here, chosen, service_endpoints(here), kind="srv")
        _check_type(here, name, kind)
        request = filled(kind.Request, values or "{}")
        client = here.create_client(kind, name)
        while True:
            started_ns = here.get_clock().now_ns
            _call_once(here, client, request, timeout_s, as_json=as_json)
            if rate is None:
                break
            passed_s = (here.get_clock().now_ns - started_ns) / 1e9
            wait_for(here, lambda: False, max(0.0, 1 / rate - passed_s))


def _wait_for_server(here: "Node", name: str, timeout_s: float | None) -> None:
    every = services(here, hidden=True)
    if name in every:
        return
    hint = did_you_mean(name, every)
    note(f"waiting for service {name} to become available{hint or '...'}")
    if not wait_for(here, lambda: name in services(here, hidden=True), timeout_s):
        fail(f"no server of {name}{hint}")


def _check_type(here: "Node", name: str, kind: Any) -> None:
    """Fail if the server has another type: it would not receive the request."""
    from navette.msgs import type_name

    served = types_of(here, name)
    if type_name(kind) not in served:
        fail(f"service {name} has type {', '.join(served)}, not {type_name(kind)}")


def _call_once(
    here: "Node",
    client: "Client",
    request: Any,
    timeout_s: float | None,
    *,
    as_json: bool,
) -> None:
    from navette.ros2.packages.rosidl_runtime_py import message_to_ordereddict

    client.wait_for_service(timeout_s)
    future = client.call_async(request)
    if not as_json:
        show(f"{styled('requester: making request:', dim=True)} {request!r}\n")
    if not wait_for(here, future.done, timeout_s):
        fail(
            f"service {client.service_name}: no response in {timeout_s:g} s"
            " (-w S waits longer)"
        )
    if future.exception() is not None:
        fail(str(future.exception()))
    response: Any = future.result()
    if as_json:
        show_json(message_to_ordereddict(response))
    else:
        show(f"{styled('response:', bold=True)}\n{response!r}\n")
