"""``navette stop``: engage and release the emergency stop of every robot."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any

from navette.cli.options import Option
from navette.cli.output import show
from navette.cli.session import connect, endpoints, fail, wait_for
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
) -> None:
    """Stop the robot at once; it stays stopped until --release.

    The stop beats every other command: of navigation, of operators and of programs that
    publish /cmd_vel. The goal continues after the release, or ends if the arbiter's
    parameter after_stop is "end".
    """
    from navette.msgs.std_msgs.msg import Bool, Empty

    message: Any = Empty() if release else Bool(data=True)
    wanted = topics.EMERGENCY_STOP_RELEASE if release else topics.EMERGENCY_STOP
    with connect() as node:
        prefixes = _robots(node)
        if not prefixes:
            fail(
                f"no node subscribes to {topics.EMERGENCY_STOP.name}: start an "
                "arbiter with navette run navette arbiter, or check navette doctor"
            )
        confirmed = _Confirmations(node, prefixes)
        publishers = {
            prefix: node.create_publisher(type(message), prefix + wanted.name, 1)
            for prefix in prefixes
        }

        def send() -> None:
            for prefix in confirmed.waiting(stopped=not release):
                publishers[prefix].publish(message)

        send()
        node.create_timer(_REPEAT_S, send)
        wait_for(node, lambda: not confirmed.waiting(stopped=not release), _CONFIRM_S)
        missing = confirmed.waiting(stopped=not release)
        what = "released" if release else "stopped until: navette stop --release"
        for prefix in prefixes:
            if prefix not in missing:
                show(f"{prefix.lstrip('/') or 'robot'}: {what}")
        if missing:
            state = "released" if release else "engaged"
            names = ", ".join(p + topics.COMMANDER.name for p in missing)
            fail(f"the emergency stop is not {state} according to {names}")


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
