"""``navette node``: which nodes run, and what each says and hears."""

from typing import TYPE_CHECKING, Annotated

from navette.cli.commands import Group
from navette.cli.completing import complete_nodes
from navette.cli.options import Argument, Option
from navette.cli.output import beside, is_terminal, show, show_json, styled
from navette.cli.service_calls import chosen_node, node_names, note_none
from navette.cli.session import connect, is_hidden, is_of_every_node
from navette.cli.stderr import note

if TYPE_CHECKING:
    from navette.runtime import Node

node = Group(
    name="node",
    help="List and inspect nodes.",
)

Json = Annotated[bool, Option("--json", help="Print JSON, for programs.")]


@node.command("list")
def list_(
    all_: Annotated[
        bool, Option("--all", "-a", help="Also hidden ones (_name).")
    ] = False,
    count: Annotated[
        bool, Option("--count-nodes", "-c", help="Only their number.")
    ] = False,
    as_json: Json = False,
) -> None:
    """List the nodes that run."""
    with connect() as here:
        names = node_names(here, hidden=all_)
        if not (names or count or as_json):
            note_none(here, "nodes")
    if count:
        show(str(len(names)))
    elif as_json:
        show_json(names)
    else:
        if len(set(names)) < len(names):
            note("some nodes share a name: which of them answers is chance")
        for name in names:
            show(name)


@node.command()
def info(
    name: Annotated[
        str,
        Argument(metavar="NODE", help="As /planner.", complete=complete_nodes),
    ],
    include_hidden: Annotated[
        bool,
        Option("--include-hidden", help="Also hidden topics, services, actions."),
    ] = False,
    as_json: Json = False,
) -> None:
    """Say what a node subscribes to, publishes, serves and calls."""
    with connect() as here:
        full = chosen_node(here, name)
        same = node_names(here, hidden=True).count(full)
        if same > 1:
            note(f"{same} nodes are named {full}: this is all of them together")
        sections = _sections(here, full, hidden=include_hidden)
    if as_json:
        keyed = {title.lower().replace(" ", "_"): s for title, s in sections.items()}
        show_json({"node": full, **keyed})
        return
    if is_terminal():
        _show_to_a_person(full, sections)
        return
    show(full)
    for title, names in sections.items():
        show(f"  {title}:")
        # An empty section is an empty line, as ROS 2's command prints it.
        show("\n".join(f"    {name}: {', '.join(names[name])}" for name in names))


def _show_to_a_person(full: str, sections: dict[str, dict[str, list[str]]]) -> None:
    """Types in a column; in the background what is empty or as in every node."""
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
    """Heading → name → types."""
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
