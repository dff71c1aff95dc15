"""``navette component``: load nodes into running containers."""

from typing import TYPE_CHECKING, Annotated, Any

import click

from navette.cli.commands import Group
from navette.cli.completing import complete_nodes
from navette.cli.completing_installed import complete_packages
from navette.cli.options import Argument, Json, Option
from navette.cli.output import show, show_json, styled
from navette.cli.service_calls import (
    ServiceRequest,
    ServiceResponse,
    call_all,
    chosen_node,
    node_names,
)
from navette.cli.session import FAILED, connect, fail, service_endpoints
from navette.cli.stderr import note
from navette.errors import InvalidValueError

if TYPE_CHECKING:
    from navette.runtime import Node

component = Group(
    name="component",
    help="Load nodes into running containers and unload them.",
)

Container = Annotated[
    str,
    Argument(
        metavar="CONTAINER",
        help="Container name, such as /component_container.",
        complete=complete_nodes,
    ),
]
Quiet = Annotated[
    bool, Option("--quiet", "-q", help="Print only ids and names of components.")
]

_SERVICES = {
    "list_nodes": "composition_interfaces/srv/ListNodes",
    "load_node": "composition_interfaces/srv/LoadNode",
    "unload_node": "composition_interfaces/srv/UnloadNode",
}
_LOAD_S = 30.0  # a node may compile its kernels


@component.command("list")
def list_(
    container: Annotated[
        str | None,
        Argument(
            metavar="[CONTAINER]",
            help="Container name. Default: all containers.",
            complete=complete_nodes,
        ),
    ] = None,
    containers_only: Annotated[
        bool, Option("--containers-only", help="Print only the containers.")
    ] = False,
    as_json: Json = False,
) -> None:
    """List containers and their components."""
    with connect() as here:
        names = [_chosen(here, container)] if container else containers(here)
        requests = [_request(name, "list_nodes") for name in names]
        answers = dict(zip(names, call_all(here, requests), strict=True))
    held = {
        name: dict(zip(r.unique_ids, r.full_node_names, strict=True))
        for name, (r, _) in answers.items()
        if r is not None
    }
    for name, (response, reason) in answers.items():
        if response is None:
            note(f"{name}: {reason}")
    if as_json:
        show_json({n: {str(i): c for i, c in own.items()} for n, own in held.items()})
    else:
        for name, own in held.items():
            if container is None:
                show(styled(name, bold=True))
            indent = "" if container else "  "
            for number, node in own.items() if not containers_only else ():
                show(f"{indent}{number}  {node}")
    if len(held) < len(names):
        raise click.exceptions.Exit(FAILED)


@component.command()
def load(
    container: Container,
    package: Annotated[
        str,
        Argument(
            metavar="PACKAGE",
            help="Package of the component.",
            complete=complete_packages,
        ),
    ],
    plugin: Annotated[
        str,
        Argument(metavar="PLUGIN", help="package::Class or module:Class."),
    ],
    node_name: Annotated[
        str, Option("--node-name", "-n", metavar="NAME", help="Name of the node.")
    ] = "",
    node_namespace: Annotated[
        str,
        Option("--node-namespace", metavar="NAMESPACE", help="Namespace of the node."),
    ] = "",
    log_level: Annotated[
        str, Option("--log-level", metavar="LEVEL", help="debug, info, warn, …")
    ] = "",
    remap_rule: Annotated[
        list[str] | None,
        Option(
            "--remap-rule",
            "-r",
            metavar="FROM:=TO",
            help="Remap a name; repeatable.",
        ),
    ] = None,
    parameter: Annotated[
        list[str] | None,
        Option(
            "--parameter",
            "-p",
            metavar="NAME:=VALUE",
            help="Set a parameter; repeatable.",
        ),
    ] = None,
    quiet: Quiet = False,
) -> None:
    """Load a node into a container."""
    fields = {
        "package_name": package,
        "plugin_name": plugin,
        "node_name": node_name,
        "node_namespace": node_namespace,
        "log_level": _level(log_level),
        "remap_rules": remap_rule or [],
        "parameters": [_parameter(each) for each in parameter or ()],
    }
    with connect() as here:
        name = _chosen(here, container)
        (answer,) = call_all(here, [_request(name, "load_node", **fields)], _LOAD_S)
    response = _succeeded(answer, f"Failed to load component {plugin}")
    number, node = response.unique_id, response.full_node_name
    if quiet:
        show(f"{number}  {node}")
    else:
        show(f"Loaded component {number} into '{name}' container node as '{node}'")


@component.command()
def unload(
    container: Container,
    component_uid: Annotated[
        list[int], Argument(metavar="ID...", help="Ids, as printed by list.")
    ],
    quiet: Quiet = False,
) -> None:
    """Unload nodes from a container."""
    with connect() as here:
        name = _chosen(here, container)
        for number in component_uid:
            request = _request(name, "unload_node", unique_id=number)
            (answer,) = call_all(here, [request])
            where = f"component {number} from '{name}' container node"
            _succeeded(answer, f"Failed to unload {where}")
            show(str(number) if quiet else f"Unloaded {where}")


@component.command()
def types(as_json: Json = False) -> None:
    """List the components of installed packages."""
    from importlib.metadata import entry_points

    from navette.ros2.launch.components import GROUP

    found: dict[str, list[str]] = {}
    for point in entry_points(group=GROUP):
        package = point.value.partition(":")[0].partition(".")[0]
        found.setdefault(package, []).append(point.name)
    if as_json:
        show_json({package: sorted(found[package]) for package in sorted(found)})
        return
    for package in sorted(found):
        show(styled(package, bold=True))
        for name in sorted(found[package]):
            show(f"  {name}")


def containers(here: "Node") -> list[str]:
    """Return the sorted full names of nodes that can load components."""
    serving = {
        end.topic.removesuffix("/_container/load_node")
        for end in service_endpoints(here)
        if end.type_name == _SERVICES["load_node"]
    }
    return [name for name in node_names(here, hidden=True) if name in serving]


def _chosen(here: "Node", name: str) -> str:
    full = chosen_node(here, name)
    known = containers(here)
    if full not in known:
        fail(
            f"node {full} is not a container; containers: {', '.join(known) or 'none'}"
        )
    return full


def _request(container: str, service: str, **fields: Any) -> ServiceRequest:
    name = f"{container}/_container/{service}"
    return ServiceRequest(name, _SERVICES[service], fields)


def _succeeded(answer: ServiceResponse, otherwise: str) -> Any:
    """Return the response; the command fails without one or if it reports a failure."""
    if answer.response is None:
        fail(f"{otherwise}: {answer.reason}")
    if not answer.response.success:
        fail(f"{otherwise}: {answer.response.error_message}")
    return answer.response


def _level(name: str) -> int:
    from navette.runtime import LoggingSeverity

    known = {each.name.lower(): int(each) for each in LoggingSeverity}
    if name and name.lower() not in known:
        raise InvalidValueError(
            f"--log-level {name!r} is unknown; known: {', '.join(known)}"
        )
    return known[name.lower()] if name else 0


def _parameter(text: str) -> Any:
    """Parse ``name:=value`` to a Parameter message."""
    from navette.msgs.rcl_interfaces.msg import Parameter
    from navette.runtime.parameter import get_parameter_value

    name, assigned, value = text.partition(":=")
    if not (name and assigned):
        raise InvalidValueError(f"--parameter {text!r} is not NAME:=VALUE")
    return Parameter(name=name, value=get_parameter_value(value))
