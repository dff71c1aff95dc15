"""``navette action list``, ``type``, ``find`` and ``info``."""

from typing import TYPE_CHECKING, Annotated

from navette.cli.action.options import ActionName, ActionType
from navette.cli.nearest import did_you_mean
from navette.cli.options import Json, Option
from navette.cli.output import show, show_json, show_names
from navette.cli.service.listing import show_types_of
from navette.cli.service_calls import note_none
from navette.cli.session import connect, endpoints, fail

if TYPE_CHECKING:
    from navette.runtime import Node
    from navette.transports import EndpointKind

Count = Annotated[bool, Option("--count-actions", "-c", help="Print only the number.")]
ShowTypes = Annotated[bool, Option("--show-types", "-t", help="Also print the types.")]

_FEEDBACK = "/_action/feedback"


def list_(
    show_types: ShowTypes = False, count: Count = False, as_json: Json = False
) -> None:
    """List actions."""
    with connect() as here:
        found = actions(here)
        if not (found or count or as_json):
            note_none(here, "actions")
    if count:
        show(str(len(found)))
    elif as_json:
        show_json([{"name": name, "types": found[name]} for name in found])
    else:
        show_types_of(found, with_types=show_types)


def type_(action: ActionName) -> None:
    """Print the type of an action."""
    with connect() as here:
        types = types_of(here, here.resolve_topic_name(action))
    for each in types:
        show(each)


def find(action_type: ActionType, count: Count = False, as_json: Json = False) -> None:
    """List actions of a type."""
    from navette.cli.message_types import if_unknown

    parts = action_type.split("/")
    full = f"{parts[0]}/action/{parts[1]}" if len(parts) == 2 else action_type
    with connect() as here:
        found = [name for name, types in actions(here).items() if full in types]
    if not (found or count or as_json):
        fail(f"no action has type {full}{if_unknown(full)}")
    show_names(found, count=count, as_json=as_json)


def info(
    action: ActionName,
    show_types: ShowTypes = False,
    count: Annotated[
        bool, Option("--count", "-c", help="Print only the numbers.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Show the servers and clients of an action."""
    from navette.transports import EndpointKind

    with connect() as here:
        name = here.resolve_topic_name(action)
        types_of(here, name)
        clients = _users(here, name, EndpointKind.SUBSCRIPTION)
        servers = _users(here, name, EndpointKind.PUBLISHER)
    if as_json:
        show_json({"name": name, "clients": clients, "servers": servers})
        return
    show(f"Action: {name}")
    for title, users in (("clients", clients), ("servers", servers)):
        show(f"Action {title}: {len(users)}")
        for user in users if not count else ():
            show(f"    {user['node']}" + (f" [{user['type']}]" if show_types else ""))


def _users(here: "Node", name: str, kind: "EndpointKind") -> list[dict[str, str]]:
    """Find the nodes by the feedback topic: servers publish it, clients subscribe."""
    return [
        {
            "node": end.node_full_name,
            "type": end.type_name.removesuffix("_FeedbackMessage"),
        }
        for end in endpoints(here, name + _FEEDBACK, kind=kind)
    ]


def actions(here: "Node") -> dict[str, list[str]]:
    """Return the types of all actions by name, sorted."""
    from navette.runtime.action import get_action_names_and_types

    return dict(get_action_names_and_types(here))


def types_of(here: "Node", name: str) -> list[str]:
    """Return the types of an action; the command fails if there is none."""
    every = actions(here)
    if name not in every:
        fail(f"no server of the action {name}{did_you_mean(name, every)}")
    return every[name]
