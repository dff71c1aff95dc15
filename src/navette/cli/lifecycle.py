"""``navette lifecycle``: states and transitions of managed nodes."""

from typing import TYPE_CHECKING, Annotated, Any

import click

from navette.cli.commands import Group
from navette.cli.completing import complete_managed_nodes, complete_transitions
from navette.cli.nearest import did_you_mean
from navette.cli.options import (
    AllNodes,
    Argument,
    CountNodes,
    HiddenNodes,
    Json,
    Option,
)
from navette.cli.output import harmless, show, show_json, show_names, styled
from navette.cli.service_calls import (
    GET_STATE,
    RESPONSE_TIMEOUT_S,
    ServiceRequest,
    call,
    call_all,
    chosen_node,
    managed_nodes,
    note_none,
    response_of,
)
from navette.cli.session import FAILED, connect, fail, wait_for
from navette.cli.stderr import note

if TYPE_CHECKING:
    from navette.runtime import Node

lifecycle = Group(
    name="lifecycle",
    help="Inspect managed nodes and change their state.",
)

NodeName = Annotated[
    str,
    Argument(
        metavar="NODE",
        help="Node name, such as /camera.",
        complete=complete_managed_nodes,
    ),
]


@lifecycle.command()
def nodes(
    all_: AllNodes = False,
    count: CountNodes = False,
    as_json: Json = False,
) -> None:
    """List managed nodes."""
    with connect() as here:
        names = managed_nodes(here, hidden=all_)
        if not (names or count or as_json):
            note_none(here, "managed nodes")
    show_names(names, count=count, as_json=as_json)


@lifecycle.command()
def get(
    node_name: Annotated[
        str | None,
        Argument(
            metavar="[NODE]",
            help="Default: all managed nodes.",
            complete=complete_managed_nodes,
        ),
    ] = None,
    include_hidden_nodes: HiddenNodes = False,
    as_json: Json = False,
) -> None:
    """Print the state of managed nodes."""
    with connect() as here:
        every = managed_nodes(here, hidden=include_hidden_nodes)
        names = [_managed(here, node_name)] if node_name else every
        questions = [
            ServiceRequest(f"{name}/get_state", GET_STATE, {}) for name in names
        ]
        answers = dict(zip(names, call_all(here, questions), strict=True))
        if not (names or as_json):
            note_none(here, "managed nodes")
    states = {n: a.response.current_state for n, a in answers.items() if a.response}
    for name, (response, reason) in answers.items():
        if response is None:
            note(f"{name}: {reason}")
    if as_json:
        shown = {n: {"id": s.id, "label": s.label} for n, s in states.items()}
        show_json(shown[names[0]] if node_name and shown else shown)
    else:
        for name, state in states.items():
            head = "" if node_name else f"{name}: "
            number = styled(f"[{state.id}]", dim=True)
            show(f"{head}{harmless(state.label)} {number}")
    if len(states) < len(names):
        raise click.exceptions.Exit(FAILED)


@lifecycle.command("set")
def set_(
    node_name: NodeName,
    transition: Annotated[
        str,
        Argument(
            metavar="TRANSITION",
            help="configure, activate, deactivate, cleanup, shutdown, or an id.",
            complete=complete_transitions,
        ),
    ],
) -> None:
    """Trigger a transition of a managed node."""
    with connect() as here:
        name = _managed(here, node_name)
        available = transitions(here, name)
        chosen = _chosen(transition, [each.transition for each in available])
        response = _change(here, name, chosen)
    if not response.success:
        fail("Transitioning failed")
    show("Transitioning successful")


@lifecycle.command("list")
def list_(
    node_name: NodeName,
    all_: Annotated[
        bool, Option("--all", "-a", help="Include transitions from other states.")
    ] = False,
    as_json: Json = False,
) -> None:
    """List the transitions available in the current state of a managed node."""
    with connect() as here:
        name = _managed(here, node_name)
        found = transitions(here, name, every=all_)
    if as_json:
        show_json([_as_dict(each) for each in found])
        return
    for each in found:
        label, number = harmless(each.transition.label), each.transition.id
        start, goal = harmless(each.start_state.label), harmless(each.goal_state.label)
        show(f"- {styled(label, bold=True)} [{number}]")
        show(f"\tStart: {start}\n\tGoal: {goal}")


def transitions(here: "Node", name: str, *, every: bool = False) -> list[Any]:
    """Return the TransitionDescriptions of the current state, or of all states."""
    service = "get_transition_graph" if every else "get_available_transitions"
    type_name = "lifecycle_msgs/srv/GetAvailableTransitions"
    return list(call(here, f"{name}/{service}", type_name).available_transitions)


def _change(here: "Node", name: str, transition: Any) -> Any:
    """Request a transition and wait for its end, which can take long for a driver."""
    from navette.msgs.lifecycle_msgs.srv import ChangeState

    client = here.create_client(ChangeState, f"{name}/change_state")
    if not client.wait_for_service(RESPONSE_TIMEOUT_S):
        fail(f"no server of {client.service_name}")
    future = client.call_async(ChangeState.Request(transition=transition))
    if not wait_for(here, future.done, RESPONSE_TIMEOUT_S):
        note(f"waiting for {name}; Ctrl-C stops the wait, not the transition")
        wait_for(here, lambda: future.done() or not client.service_is_ready())
    got = response_of(future, client.service_name)
    return fail(got.reason) if got.response is None else got.response


def _managed(here: "Node", name: str) -> str:
    """Return the full name of a managed node; the command fails for other nodes."""
    full = chosen_node(here, name)
    known = managed_nodes(here, hidden=True)
    if full not in known:
        fail(f"node {full} is not managed; managed nodes: {', '.join(known) or 'none'}")
    return full


def _chosen(wanted: str, available: list[Any]) -> Any:
    """Return the transition with a label or, failing that, with an id."""
    for each in available:
        if each.label == wanted:
            return each
    for each in available:
        if str(each.id) == wanted:
            return each
    hint = did_you_mean(wanted, [each.label for each in available])
    lines = "".join(f"\n- {each.label} [{each.id}]" for each in available)
    return fail(
        f"no transition {wanted!r} from the current state{hint}\navailable transitions:"
        f"{lines or ' none'}"
    )


def _as_dict(described: Any) -> dict[str, Any]:
    return {
        "id": described.transition.id,
        "label": described.transition.label,
        "start": described.start_state.label,
        "goal": described.goal_state.label,
    }
