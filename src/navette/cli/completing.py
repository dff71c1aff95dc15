"""Shell completion of names in the running system.

Errors give no completions: a message would appear in the line that is being typed.
"""

import os
from collections.abc import Callable, Iterable
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import click

from navette.cli.completing_installed import (
    chosen,
    complete_action_types,
    complete_service_types,
)
from navette.cli.service_calls import (
    ServiceRequest,
    call_all,
    managed_nodes,
    node_names,
)
from navette.cli.session import connect, endpoints, is_hidden, service_endpoints
from navette.errors import NavetteError

if TYPE_CHECKING:
    from navette.runtime import Node

_RESPONSE_TIMEOUT_S = 0.5


def complete_nodes(incomplete: str) -> list[str]:
    """Complete full names of nodes."""
    return running(incomplete, node_names)


def complete_topics(incomplete: str) -> list[str]:
    """Complete full names of topics."""
    return running(incomplete, lambda here: (e.topic for e in endpoints(here)))


def complete_services(incomplete: str) -> list[str]:
    """Complete full names of services."""
    return running(incomplete, lambda here: (e.topic for e in service_endpoints(here)))


def complete_actions(incomplete: str) -> list[str]:
    """Complete full names of actions."""
    from navette.runtime.action import get_action_names_and_types

    return running(
        incomplete, lambda here: (n for n, _ in get_action_names_and_types(here))
    )


def complete_parameters(ctx: click.Context, incomplete: str) -> list[str]:
    """Complete parameter names of the given node."""
    return _called(
        ctx,
        incomplete,
        "list_parameters",
        "rcl_interfaces/srv/ListParameters",
        lambda response: response.result.names,
    )


def complete_parameter_value(ctx: click.Context, incomplete: str) -> list[str]:
    """Complete the current value of the given parameter; true and false for a bool."""
    name = str(ctx.params.get("name") or "")
    if not name:
        return []

    def values(response: Any) -> Iterable[str]:
        from navette.runtime.parameter import parameter_value_to_python
        from navette.runtime.parameter_files import format_value

        for each in response.values:
            value = parameter_value_to_python(each)
            if isinstance(value, bool):
                yield from ("true", "false")
            elif value is not None:
                yield format_value(value)

    return _called(
        ctx,
        incomplete,
        "get_parameters",
        "rcl_interfaces/srv/GetParameters",
        values,
        names=[name],
    )


def complete_managed_nodes(incomplete: str) -> list[str]:
    """Complete full names of managed nodes."""
    return running(incomplete, managed_nodes)


def complete_transitions(ctx: click.Context, incomplete: str) -> list[str]:
    """Complete labels of the transitions available in the given node."""
    return _called(
        ctx,
        incomplete,
        "get_available_transitions",
        "lifecycle_msgs/srv/GetAvailableTransitions",
        lambda response: (t.transition.label for t in response.available_transitions),
    )


def complete_type_of_service(ctx: click.Context, incomplete: str) -> list[str]:
    """Complete the type of the given service; all types if it has no server."""
    name = f"/{str(ctx.params.get('service') or '').lstrip('/')}"
    served = running(
        incomplete,
        lambda here: (e.type_name for e in service_endpoints(here, name)),
    )
    return served or complete_service_types(incomplete)


def complete_type_of_action(ctx: click.Context, incomplete: str) -> list[str]:
    """Complete the type of the given action; all types if it has no server."""
    from navette.runtime.action import get_action_names_and_types

    name = f"/{str(ctx.params.get('action') or '').lstrip('/')}"
    served = running(
        incomplete,
        lambda here: dict(get_action_names_and_types(here)).get(name, []),
    )
    return served or complete_action_types(incomplete)


def complete_message_values(ctx: click.Context, incomplete: str) -> list[str]:
    """Complete a message of the given type with its defaults, to edit."""
    return _prototype(str(ctx.params.get("type_name") or ""), "msg", incomplete)


def complete_request(ctx: click.Context, incomplete: str) -> list[str]:
    """Complete ``service call NAME``: the type, then a request with its defaults."""
    return _type_or_values(ctx, incomplete, "srv", complete_type_of_service)


def complete_goal(ctx: click.Context, incomplete: str) -> list[str]:
    """Complete ``action send_goal NAME``: the type, then a goal with its defaults."""
    return _type_or_values(ctx, incomplete, "action", complete_type_of_action)


def _type_or_values(
    ctx: click.Context,
    incomplete: str,
    kind: str,
    types: "Callable[[click.Context, str], list[str]]",
) -> list[str]:
    words = list(ctx.params.get("words") or ())
    if not words:
        return types(ctx, incomplete)
    return _prototype(words[0], kind, incomplete) if len(words) == 1 else []


def _prototype(type_name: str, kind: str, incomplete: str) -> list[str]:
    """Return the default values as YAML, unless values are already being typed."""
    if incomplete or not type_name:
        return []
    from navette.cli.message_types import full_type_name, installed_class
    from navette.ros2.packages.rosidl_runtime_py import message_to_yaml

    with suppress(NavetteError):
        cls = installed_class(full_type_name(type_name, kind))
        if cls is not None:
            part: Any = getattr(cls, "Goal", getattr(cls, "Request", cls))
            text = message_to_yaml(part(), flow_style=True).strip()
            # fish and zsh quote completions themselves.
            in_bash = os.environ.get("_NAVETTE_COMPLETE", "").startswith("bash")
            return [f'"{text}"' if in_bash else text]
    return []


def running(incomplete: str, names: "Callable[[Node], Iterable[str]]") -> list[str]:
    """Complete names of the running system; hidden ones only after a typed ``_``."""
    hidden = "_" in incomplete
    with suppress(NavetteError, click.exceptions.Exit), connect() as here:
        found = [n for n in names(here) if hidden or not is_hidden(n)]
        # The leading slash is optional.
        if incomplete and not incomplete.startswith("/"):
            found += [name.removeprefix("/") for name in found]
        return chosen(incomplete, found)
    return []


def _called(
    ctx: click.Context,
    incomplete: str,
    service: str,
    type_name: str,
    words: Callable[[Any], Iterable[str]],
    **fields: Any,
) -> list[str]:
    """Complete words from the response of a service of the given node."""
    node = str(ctx.params.get("node_name") or "").strip("/")
    request = ServiceRequest(f"/{node}/{service}", type_name, fields)

    def call(here: "Node") -> Iterable[str]:
        (answer,) = call_all(here, [request], _RESPONSE_TIMEOUT_S)
        return words(answer.response) if answer.response is not None else ()

    return running(incomplete, call) if node else []
