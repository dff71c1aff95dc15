"""``navette service list``, ``type``, ``find`` and ``info``."""

from typing import TYPE_CHECKING, Annotated

from navette.cli.nearest import did_you_mean
from navette.cli.options import Json, Option
from navette.cli.output import beside, is_terminal, show, show_json, show_names
from navette.cli.service.options import Hidden, ServiceName, ServiceType
from navette.cli.service_calls import note_none
from navette.cli.session import (
    connect,
    fail,
    is_hidden,
    is_of_every_node,
    service_endpoints,
)
from navette.cli.stderr import note

if TYPE_CHECKING:
    from navette.runtime import Node
    from navette.transports import Endpoint

Count = Annotated[bool, Option("--count-services", "-c", help="Print only the number.")]


def list_(
    show_types: Annotated[
        bool, Option("--show-types", "-t", help="Also print the types.")
    ] = False,
    count: Count = False,
    include_hidden_services: Hidden = False,
    as_json: Json = False,
) -> None:
    """List services."""
    with connect() as here:
        found = services(here, hidden=include_hidden_services)
        if not (found or count or as_json):
            note_none(here, "services")
    if count:
        show(str(len(found)))
    elif as_json:
        show_json([{"name": name, "types": found[name]} for name in found])
    elif is_terminal() and not include_hidden_services:
        own = {n: types for n, types in found.items() if not is_of_every_node(n)}
        show_types_of(own, with_types=show_types)
        if len(own) < len(found):
            note(f"and {len(found) - len(own)} that every node has (-a shows them)")
    else:
        show_types_of(found, with_types=show_types)


def show_types_of(found: dict[str, list[str]], *, with_types: bool) -> None:
    """Print a name per line; types in brackets, or in a column on a terminal."""
    if not with_types:
        lines = list(found)
    elif is_terminal():
        lines = beside((name, ", ".join(types)) for name, types in found.items())
    else:
        lines = [f"{name} [{', '.join(types)}]" for name, types in found.items()]
    for line in lines:
        show(line)


def type_(service: ServiceName) -> None:
    """Print the type of a service."""
    with connect() as here:
        name = here.resolve_service_name(service)
        types = types_of(here, name)
    for each in types:
        show(each)


def find(
    service_type: ServiceType,
    count: Count = False,
    include_hidden_services: Hidden = False,
    as_json: Json = False,
) -> None:
    """List services of a type."""
    from navette.cli.message_types import if_unknown

    parts = service_type.split("/")
    full = f"{parts[0]}/srv/{parts[1]}" if len(parts) == 2 else service_type
    with connect() as here:
        every = services(here, hidden=include_hidden_services)
    found = [name for name, types in every.items() if full in types]
    if not (found or count or as_json):
        fail(f"no service has type {full}{if_unknown(full)}")
    show_names(found, count=count, as_json=as_json)


def info(
    service: ServiceName,
    verbose: Annotated[
        bool, Option("--verbose", "-v", help="Also print the nodes.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Show the type of a service and the number of its servers and clients."""
    from navette.transports import EndpointKind

    with connect() as here:
        name = here.resolve_service_name(service)
        types = types_of(here, name)
        clients = _nodes(service_endpoints(here, name, kind=EndpointKind.CLIENT))
        servers = _nodes(service_endpoints(here, name, kind=EndpointKind.SERVICE))
    if as_json:
        users = {"clients": clients, "servers": servers}
        show_json({"name": name, "types": types, **users})
        return
    show(f"Type: {', '.join(types)}")
    for title, nodes in (("Clients", clients), ("Services", servers)):
        show(f"{title} count: {len(nodes)}")
        for node in nodes if verbose else ():
            show(f"    {node}")


def _nodes(found: "list[Endpoint]") -> list[str]:
    return [endpoint.node_full_name for endpoint in found]


def services(here: "Node", *, hidden: bool) -> dict[str, list[str]]:
    """Return the types of all services by name, sorted."""
    from navette.runtime.graph import names_and_types
    from navette.transports import EndpointKind

    every = names_and_types(service_endpoints(here, kind=EndpointKind.SERVICE))
    return {n: types for n, types in every.items() if hidden or not is_hidden(n)}


def types_of(here: "Node", name: str) -> list[str]:
    """Return the types of a service; the command fails if it has no server."""
    every = services(here, hidden=True)
    if name not in every:
        fail(f"no server of {name}{did_you_mean(name, every)}")
    return every[name]
