"""``navette stop``: engage and release the emergency stop of every robot."""

from collections.abc import Callable
from contextlib import ExitStack
from typing import TYPE_CHECKING, Annotated, Any

import click

from navette.cli.options import Option
from navette.cli.output import show
from navette.cli.session import FAILED, connect, endpoints, fail, networks, wait_for
from navette.cli.stderr import print_error
from navette.msgs import topics

if TYPE_CHECKING:
    from navette.runtime import Node

_CONFIRM_S = 2.0
_REPEAT_S = 0.05


def stop(
    release: Annotated[
        bool,
        Option("--release", help="Release the stop: the robot follows commands again."),
    ] = False,
    every: Annotated[
        bool,
        Option(
            "--all",
            help="Every robot of this user: of all runs and of the shared network.",
        ),
    ] = False,
) -> None:
    """Stop the robot at once; it stays stopped until --release.

    The stop beats every other command: of navigation, of operators and of programs that
    publish /cmd_vel. The goal continues after the release, or ends if the arbiter's
    parameter after_stop is "end".
    """
    requests: list[_Request] = []
    is_complete = True
    with ExitStack() as cleanup:
        for run in networks() if every else [None]:
            try:
                node = cleanup.enter_context(connect(run=run))
            except click.exceptions.Exit:  # reported; the other robots are stopped
                if not every:
                    raise
                is_complete = False
                continue
            requests.append(_Request(node, run, stopped=not release))
        if not any(each.prefixes for each in requests):
            fail(
                f"no node subscribes to {topics.EMERGENCY_STOP.name}: start an "
                "arbiter with navette run navette arbiter, or check navette doctor"
            )
        confirmations = [each.is_confirmed() for each in requests]
    if not (is_complete and all(confirmations)):
        raise click.exceptions.Exit(FAILED)


class _Request:
    """A request to all robots of one network, repeated until it is confirmed.

    Args:
        node: in that network; the request is published at once.
        run: name of the network, if it is one of several.
        stopped: engage or release the stop.
    """

    def __init__(self, node: "Node", run: str | None, *, stopped: bool) -> None:
        from navette.msgs.std_msgs.msg import Bool, Empty

        self.prefixes = _robots(node)
        self._node, self._stopped = node, stopped
        self._run = "" if run is None else f"{run}/"
        self._message: Any = Bool(data=True) if stopped else Empty()
        topic = topics.EMERGENCY_STOP if stopped else topics.EMERGENCY_STOP_RELEASE
        self._publishers = {
            prefix: node.create_publisher(type(self._message), prefix + topic.name, 1)
            for prefix in self.prefixes
        }
        self._confirmed = _Confirmations(node, self.prefixes)
        self._send()
        node.create_timer(_REPEAT_S, self._send)

    def is_confirmed(self) -> bool:
        """Wait for the robots, print a line for each, and return whether all did it."""
        wait_for(self._node, lambda: not self._waiting(), _CONFIRM_S)
        missing = self._waiting()
        end = "navette stop --all --release" if self._run else "navette stop --release"
        what = f"stopped until: {end}" if self._stopped else "released"
        for prefix in self.prefixes:
            if prefix not in missing:
                show(f"{self._run}{prefix.lstrip('/') or 'robot'}: {what}")
        if missing:
            state = "engaged" if self._stopped else "released"
            names = ", ".join(p + topics.COMMANDER.name for p in missing)
            where = f" of {self._run.rstrip('/')}" if self._run else ""
            print_error(
                f"the emergency stop is not {state} according to {names}{where}"
            )
        return not missing

    def _waiting(self) -> list[str]:
        return self._confirmed.waiting(stopped=self._stopped)

    def _send(self) -> None:
        for prefix in self._waiting():
            self._publishers[prefix].publish(self._message)


def _robots(node: "Node") -> list[str]:
    """Return the namespaces in which a node takes the emergency stop."""
    from navette.transports import EndpointKind

    end = topics.EMERGENCY_STOP.name
    found = {
        each.topic.removesuffix(end)
        for each in endpoints(node, kind=EndpointKind.SUBSCRIPTION)
        if each.topic.endswith(end) and each.type_name == topics.EMERGENCY_STOP.type
    }
    return sorted(found)


class _Confirmations:
    """States of the emergency stops, by namespace.

    A robot is stopped when its arbiter and the robot itself report it, as far as they
    exist.
    """

    def __init__(self, node: "Node", prefixes: list[str]) -> None:
        from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
        from navette.msgs.std_msgs.msg import Bool
        from navette.runtime import DurabilityPolicy, QoSProfile
        from navette.transports import EndpointKind

        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._prefixes = prefixes
        #: (namespace, topic) → whether it is stopped; None before a report.
        self._stopped: dict[tuple[str, str], bool | None] = {}
        for prefix in prefixes:
            for topic, kind in (
                (topics.COMMANDER, DiagnosticStatus),
                (topics.EMERGENCY_STOP_ACTIVE, Bool),
            ):
                name = prefix + topic.name
                if endpoints(node, name, kind=EndpointKind.PUBLISHER):
                    self._stopped[prefix, topic.name] = None
                    receive = self._receiver(prefix, topic.name)
                    node.create_subscription(kind, name, receive, latched)

    def waiting(self, *, stopped: bool) -> list[str]:
        """Return the namespaces that are not known to be in this state."""
        states: dict[str, list[bool | None]] = {p: [] for p in self._prefixes}
        for (prefix, _), state in self._stopped.items():
            states[prefix].append(state)
        return [
            prefix
            for prefix, reported in states.items()
            if not reported or any(state is not stopped for state in reported)
        ]

    def _receiver(self, prefix: str, topic: str) -> Callable[[Any], None]:
        from navette.runtime.stage.commander import Commander

        def receive(msg: Any) -> None:
            is_commander = topic == topics.COMMANDER.name
            stopped = Commander.of(msg).is_stopped if is_commander else msg.data
            self._stopped[prefix, topic] = stopped

        return receive
