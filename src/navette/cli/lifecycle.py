"""``navette lifecycle``: managed nodes, their states and transitions."""

from typing import TYPE_CHECKING, Annotated, Any

import click

from navette.cli.commands import Group
from navette.cli.completing import complete_managed_nodes, complete_transitions
from navette.cli.nearest import did_you_mean
from navette.cli.options import Argument, Option
from navette.cli.output import harmless, show, show_json, styled
from navette.cli.service_calls import (
    ANSWER_S,
    GET_STATE,
    Question,
    answer,
    ask,
    ask_all,
    chosen_node,
    managed_nodes,
    note_none,
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
    Argument(metavar="NODE", help="As /camera.", complete=complete_managed_nodes),
]
Hidden = Annotated[
    bool, Option("--include-hidden-nodes", help="Also nodes named _name.")
]
Json = Annotated[bool, Option("--json", help="Print JSON, for programs.")]


@lifecycle.command()
def nodes(
    all_: Annotated[
        bool, Option("--all", "-a", help="Also hidden ones (_name).")
    ] = False,
    count: Annotated[
        bool, Option("--count-nodes", "-c", help="Only their number.")
    ] = False,
    as_json: Json = False,
) -> None:
    """List the managed nodes."""
    with connect() as here:
        names = managed_nodes(here, hidden=all_)
        if not (names or count or as_json):
            note_none(here, "managed nodes")
    if count:
        show(str(len(names)))
    elif as_json:
        show_json(names)
    else:
        for name in names:
            show(name)


@lifecycle.command()
def get(
    node_name: Annotated[
        str | None,
        Argument(
            metavar="[NODE]",
            help="By default every managed node.",
            complete=complete_managed_nodes,
        ),
    ] = None,
    include_hidden_nodes: Hidden = False,
    as_json: Json = False,
) -> None:
    """Print the state that managed nodes are in."""
    with connect() as here:
        every = managed_nodes(here, hidden=include_hidden_nodes)
        names = [_managed(here, node_name)] if node_name else every
        questions = [Question(f"{name}/get_state", GET_STATE, {}) for name in names]
        answers = dict(zip(names, ask_all(here, questions), strict=True))
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
            help="As configure, activate, deactivate, cleanup, shutdown, or its id.",
            complete=complete_transitions,
        ),
    ],
) -> None:
    """Take a managed node through a transition."""
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
        bool, Option("--all", "-a", help="Also from other states.")
    ] = False,
    as_json: Json = False,
) -> None:
    """List the transitions that a managed node can make now."""
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
    """TransitionDescriptions: those of the present state, or all."""
    service = "get_transition_graph" if every else "get_available_transitions"
    type_name = "lifecycle_msgs/srv/GetAvailableTransitions"
    return list(ask(here, f"{name}/{service}", type_name).available_transitions)


def _change(here: "Node", name: str, transition: Any) -> Any:
    """Ask for a transition and wait as long as it takes: drivers take their time."""
    from navette.msgs.lifecycle_msgs.srv import ChangeState

    client = here.create_client(ChangeState, f"{name}/change_state")
    if not client.wait_for_service(ANSWER_S):
        fail(f"nobody serves {client.srv_name}")
    asked = client.call_async(ChangeState.Request(transition=transition))
    if not wait_for(here, asked.done, ANSWER_S):
        note(f"{name} is at it; Ctrl-C ends the wait for it, not the transition")
        wait_for(here, lambda: asked.done() or not client.service_is_ready())
    got = answer(asked, client.srv_name)
    return fail(got.reason) if got.response is None else got.response


def _managed(here: "Node", name: str) -> str:
    """The full name of a managed node; ends the command where it is none."""
    full = chosen_node(here, name)
    known = managed_nodes(here, hidden=True)
    if full not in known:
        fail(f"node {full} is not managed; managed: {', '.join(known) or 'none'}")
    return full


def _chosen(wanted: str, available: list[Any]) -> Any:
    """The transition of a label or, failing that, of an id."""
    for each in available:
        if each.label == wanted:
            return each
    for each in available:
        if str(each.id) == wanted:
            return each
    hint = did_you_mean(wanted, [each.label for each in available])
    lines = "".join(f"\n- {each.label} [{each.id}]" for each in available)
    return fail(
        f"no transition {wanted!r} from this state{hint or ','} available ones"
        f" are:{lines or ' none'}"
    )


def _as_dict(described: Any) -> dict[str, Any]:
    return {
        "id": described.transition.id,
        "label": described.transition.label,
        "start": described.start_state.label,
        "goal": described.goal_state.label,
    }
