"""``navette node``: running nodes, their topics, services and actions."""

from typing import TYPE_CHECKING, Annotated

from navette.cli.commands import Group
from navette.cli.completing import complete_nodes
from navette.cli.options import AllNodes, Argument, CountNodes, Json, Option
from navette.cli.output import beside, is_terminal, show, show_json, show_names, styled
from navette.cli.service_calls import chosen_node, node_names, note_none
from navette.cli.session import connect, is_hidden, is_of_every_node
from navette.cli.stderr import note

if TYPE_CHECKING:
    from navette.runtime import Node

node = Group(
    name="node",
    help="List and inspect nodes.",
)


@node.command("list")
def list_(
    all_: AllNodes = False,
    count: CountNodes = False,
    as_json: Json = False,
) -> None:
    """List nodes."""
    with connect() as here:
        names = node_names(here, hidden=all_)
        if not (names or count or as_json):
            note_none(here, "nodes")
    if len(set(names)) < len(names) and not (count or as_json):
        note("some nodes share a name: service calls reach any one of them")
    show_names(names, count=count, as_json=as_json)


@node.command()
def info(
    name: Annotated[
        str,
        Argument(
            metavar="NODE", help="Node name, such as /planner.", complete=complete_nodes
        ),
    ],
    include_hidden: Annotated[
        bool,
        Option("--include-hidden", help="Include hidden topics, services and actions."),
    ] = False,
    as_json: Json = False,
) -> None:
    """Show the topics, services and actions of a node."""
    with connect() as here:
        full = chosen_node(here, name)
        same = node_names(here, hidden=True).count(full)
        if same > 1:
            note(f"{same} nodes are named {full}; showing all of them together")
        sections = _sections(here, full, hidden=include_hidden)
    if as_json:
        keyed = {title.lower().replace(" ", "_"): s for title, s in sections.items()}
        show_json({"node": full, **keyed})
        return
    if is_terminal():
        _show_in_columns(full, sections)
        return
    show(full)
    for title, names in sections.items():
        show(f"  {title}:")
        # An empty section is an empty line, as ROS 2's command prints it.
        show("\n".join(f"    {name}: {', '.join(names[name])}" for name in names))


def _show_in_columns(full: str, sections: dict[str, dict[str, list[str]]]) -> None:
    """Print types in a column; empty sections and standard endpoints are dim."""
    show(styled(full, bold=True))
    rows = [(n, ", ".join(t)) for names in sections.values() for n, t in names.items()]
    lines = iter(beside(rows, indent=4, fades=_is_usual))
    for title, names in sections.items():
        none = "" if names else styled("  none", dim=True)
        show(f"  {styled(title, bold=True)}{none}")
        for _ in names:
            show(next(lines))


def _is_usual(name: str) -> bool:
    return name in ("/rosout", "/parameter_events") or is_of_every_node(name)


def _sections(
    here: "Node", full: str, *, hidden: bool
) -> dict[str, dict[str, list[str]]]:
    """Return the types by heading and name."""
    from navette.runtime.action import (
        get_action_client_names_and_types_by_node,
        get_action_server_names_and_types_by_node,
    )

    namespace, _, base = full.rpartition("/")
    whose = (base, namespace or "/")
    found = {
        "Subscribers": here.get_subscriber_names_and_types_by_node(*whose),
        "Publishers": here.get_publisher_names_and_types_by_node(*whose),
        "Service Servers": here.get_service_names_and_types_by_node(*whose),
        "Service Clients": here.get_client_names_and_types_by_node(*whose),
        "Action Servers": get_action_server_names_and_types_by_node(here, *whose),
        "Action Clients": get_action_client_names_and_types_by_node(here, *whose),
    }
    return {
        title: {n: types for n, types in pairs if hidden or not is_hidden(n)}
        for title, pairs in found.items()
    }
