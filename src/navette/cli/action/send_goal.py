"""``navette action send_goal``: send a goal given as YAML and print its result."""

from typing import TYPE_CHECKING, Annotated, Any

import click

from navette.cli.action.listing import actions, types_of
from navette.cli.action.options import ActionName
from navette.cli.completing import complete_goal
from navette.cli.message_yaml import yaml_of
from navette.cli.nearest import did_you_mean
from navette.cli.options import Argument, Json, Option, Stdin
from navette.cli.output import is_terminal, show, show_json, styled
from navette.cli.request_builder import filled, from_stdin, type_and_values
from navette.cli.session import FAILED, connect, fail, service_endpoints, wait_for
from navette.cli.stderr import note

if TYPE_CHECKING:
    from navette.runtime import Future, Node
    from navette.runtime.action import ActionClient
    from navette.runtime.action.client import ClientGoalHandle

_CANCEL_S = 5.0
_INDENT = 4


def send_goal(
    action: ActionName,
    words: Annotated[
        list[str] | None,
        Argument(
            metavar="[TYPE] [YAML]",
            help="Action type (default: that of the server), and the goal fields that"
            " differ from their defaults: '{order: 5}'.",
            complete=complete_goal,
        ),
    ] = None,
    feedback: Annotated[
        bool, Option("--feedback", "-f", help="Print feedback.")
    ] = False,
    timeout: Annotated[
        float | None,
        Option("--timeout", "-t", metavar="S", help="Cancel the goal after S seconds."),
    ] = None,
    wait: Annotated[
        float,
        Option(
            "--wait",
            "-w",
            metavar="S",
            help="Wait S seconds for a server; 0: no limit.",
        ),
    ] = 5.0,
    stdin: Stdin = False,
    as_json: Json = False,
) -> None:
    """Send a goal and print its result; Ctrl-C cancels the goal.

    The exit code is 0 only if the goal succeeded.
    """
    from navette.cli.message_types import interface_class
    from navette.runtime.action import ActionClient

    type_name, values = type_and_values(words or [], "action")
    if stdin:
        values = from_stdin()
    with connect() as here:
        name = here.resolve_topic_name(action)
        _wait_for_server(here, name, wait or None)
        chosen = type_name or types_of(here, name)[0]
        kind = interface_class(here, chosen, service_endpoints(here), kind="action")
        goal = filled(kind.Goal, values or "{}")
        client = ActionClient(here, kind, name)
        if not client.wait_for_server(wait or None):
            fail(f"no server of the action {name}")
        report = _Report(as_json=as_json)
        report.print("Sending goal:", _yaml(goal, " "))
        sent = client.send_goal_async(goal, report.feedback if feedback else None)
        try:
            status = _follow(here, client, sent, timeout, report)
        except KeyboardInterrupt:
            _cancel(here, sent, report)
            raise
    if status != "SUCCEEDED":
        raise click.exceptions.Exit(FAILED)


class _Report:
    """Printer of a goal's progress: like ROS 2's command, or as lines of JSON."""

    def __init__(self, *, as_json: bool) -> None:
        self._as_json = as_json

    def print(self, title: str, text: str = "") -> None:
        if not self._as_json:
            show(styled(title, bold=True) + (f"\n{text}" if text else ""))

    def feedback(self, message: Any) -> None:
        if self._as_json:
            show_json({"feedback": _fields(message.feedback)})
        else:
            self.print("Feedback:", _yaml(message.feedback))

    def result(self, status: str, message: Any) -> None:
        if self._as_json:
            show_json({"status": status, "result": _fields(message)})
        else:
            self.print("Result:", _yaml(message))
            self.print(f"Goal finished with status: {status}")

    def rejected(self) -> None:
        if self._as_json:
            show_json({"status": "REJECTED", "result": None})
        else:
            self.print("Goal was rejected.")


def _follow(
    here: "Node",
    client: "ActionClient",
    sent: "Future[ClientGoalHandle]",
    timeout_s: float | None,
    report: _Report,
) -> str:
    """Wait for the end of the goal and return the name of its status."""
    from navette.runtime.action.goal_states import STATUS_NAMES

    _wait_with_server(here, client, sent)
    handle = sent.result()
    if handle is None or not handle.accepted:
        report.rejected()
        return "REJECTED"
    report.print(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n")
    done = handle.get_result_async()
    if not _wait_with_server(here, client, done, timeout_s):
        note(f"no result in {timeout_s:g} s")
        _cancel(here, sent, report)
        wait_for(here, done.done, _CANCEL_S)
        if not done.done():
            fail(f"action {client.action_name}: no result after cancelling")
    answer: Any = done.result()
    status = STATUS_NAMES[answer.status]
    report.result(status, answer.result)
    return status


def _wait_with_server(
    here: "Node",
    client: "ActionClient",
    future: "Future[Any]",
    timeout_s: float | None = None,
) -> bool:
    """Wait for a response as long as there is a server; return whether it arrived."""
    wait_for(here, lambda: future.done() or not client.server_is_ready(), timeout_s)
    if future.done():
        if future.exception() is not None:
            fail(str(future.exception()))
        return True
    if not client.server_is_ready():
        fail(f"action {client.action_name}: the server was closed")
    return False


def _cancel(here: "Node", sent: "Future[ClientGoalHandle]", report: _Report) -> None:
    """Cancel the goal if it was accepted."""
    wait_for(here, sent.done, _CANCEL_S)
    handle = sent.result() if sent.done() else None
    if handle is None or not handle.accepted:
        return
    report.print("Canceling goal...")
    future = handle.cancel_goal_async()
    wait_for(here, future.done, _CANCEL_S)
    response: Any = future.result() if future.done() else None
    if response is None or not response.goals_canceling:
        note("the server did not cancel the goal")
    else:
        report.print("Goal canceled.")


def _yaml(message: Any, before: str = "") -> str:
    """Indent all lines on a terminal; in a pipe only the first, as ROS 2 does."""
    if is_terminal():
        return yaml_of(message, indent=_INDENT)
    return " " * _INDENT + before + yaml_of(message)


def _fields(message: Any) -> Any:
    from navette.ros2.packages.rosidl_runtime_py import message_to_ordereddict

    return message_to_ordereddict(message)


def _wait_for_server(here: "Node", name: str, timeout_s: float | None) -> None:
    every = actions(here)
    if name in every:
        return
    hint = did_you_mean(name, every)
    note(f"waiting for an action server of {name} to become available{hint or '...'}")
    if not wait_for(here, lambda: name in actions(here), timeout_s):
        fail(f"no server of the action {name}{hint}")
