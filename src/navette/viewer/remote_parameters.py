"""Parameters of nodes of other processes, through their ROS 2 parameter services.

Parameters are listed, read and described once, as soon as a client requests them; later
changes arrive on ``/parameter_events``. No method blocks.
"""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from navette.errors import NavetteError
from navette.viewer.frames import WireParameter
from navette.viewer.graph_access import GraphAccess
from navette.viewer.node_reports import NodeReports
from navette.viewer.parameters import (
    ParameterText,
    from_wire,
    split_name,
    to_wire,
    value_of,
    wire_name,
)
from navette.viewer.service_calls import OnResponse, ServiceCalls
from navette.viewer.thread_bridge import ThreadBridge
from navette.viewer.wall_clock import WallClock

LIST = "rcl_interfaces/srv/ListParameters"
_GET = "rcl_interfaces/srv/GetParameters"
_DESCRIBE = "rcl_interfaces/srv/DescribeParameters"
_SET = "rcl_interfaces/srv/SetParameters"

# Limits against nodes that report absurd numbers of parameters.
_MAX_NAMES = 1000
_MAX_VALUES = 10_000
_TIMEOUT_S = 2.0  # longer than the default: a node may be busy
_RETRY_S = 5.0  # until a node that did not respond is called again

OnEnd = Callable[[str], None]
"""Called when a request has ended, with the reason of the failure or ""."""


@dataclass
class _Remote:
    """A node of another process; its successor of the same name has another gid."""

    gid: bytes
    is_known: bool = False
    requested_s: float | None = None
    waiting: list[OnEnd] = field(default_factory=list)


class RemoteParameters:
    """Cache of the parameters of nodes of other processes.

    Clients receive values that are new, changed or (None) deleted, and descriptions.
    """

    def __init__(
        self,
        reports: NodeReports,
        *,
        bridge: ThreadBridge,
        graph: GraphAccess,
        service_calls: ServiceCalls,
        clock: WallClock,
    ) -> None:
        self._reports = reports
        self._bridge = bridge
        self._graph = graph
        self._service_calls = service_calls
        self._clock = clock
        self._nodes: dict[str, _Remote] = {}
        #: Values by full name; includes nodes that only published events.
        self.values: dict[str, WireParameter] = {}
        self.texts: dict[str, ParameterText] = {}

    # -- nodes ------------------------------------------------------------------

    def set_nodes(self, serving: Mapping[str, bytes]) -> None:
        """Set the nodes that serve their parameters, with the gid of that service.

        Parameters of nodes that are gone are dropped.
        """
        for name, remote in list(self._nodes.items()):
            if serving.get(name) != remote.gid:
                del self._nodes[name]
                self._forget(name)
                _finish(remote, f"node {name} left the graph")
        for name, gid in serving.items():
            if name not in self._nodes:
                self._nodes[name] = _Remote(gid)

    def _forget(self, node: str) -> None:
        names = [name for name in self.values if split_name(name)[0] == node]
        for name in names:
            del self.values[name]
            self.texts.pop(name, None)
        if names:
            self._changed([WireParameter(name, None) for name in names])

    # -- reading ---------------------------------------------------------------

    def fetch(self, done: Callable[[], None] | None = None) -> None:
        """Read the parameters of the nodes that were not read yet.

        ``done`` is called when all of them have responded or failed; without it, nodes
        that failed to respond a moment ago are skipped.
        """
        now_s = self._clock.now_s
        unknown = [
            name
            for name, remote in self._nodes.items()
            if not remote.is_known
            and (
                done
                or remote.requested_s is None
                or now_s - remote.requested_s > _RETRY_S
            )
        ]
        left = len(unknown)

        def one_is_done(_reason: str) -> None:
            nonlocal left
            left -= 1
            if not left and done is not None:
                done()

        for name in unknown:
            self._fetch(name, one_is_done)
        if not unknown and done is not None:
            done()

    def _fetch(self, node: str, done: OnEnd) -> None:
        """Call ``done`` with the reason of the failure, or with ""."""
        remote = self._nodes[node]
        remote.waiting.append(done)
        if len(remote.waiting) > 1:  # already requested
            return
        remote.requested_s = self._clock.now_s

        def listed(response: Any, reason: str) -> None:
            if self._nodes.get(node) is not remote:
                return
            if response is None:
                _finish(remote, f"node {node}: {reason}")
            else:
                self._read(node, remote, list(response.result.names)[:_MAX_NAMES])

        self._call(f"{node}/list_parameters", LIST, {}, listed)

    def _read(self, node: str, remote: _Remote, names: list[str]) -> None:
        def got(response: Any, reason: str) -> None:
            if self._nodes.get(node) is not remote:
                return
            if response is None:
                _finish(remote, f"node {node}: {reason}")
                return
            remote.is_known = True
            self.store(node, zip(names, response.values, strict=False))
            _finish(remote, "")

        def described(response: Any, _reason: str) -> None:
            # Without descriptions, parameters can still be shown and set.
            if response is not None and self._nodes.get(node) is remote:
                found = zip(names, response.descriptors, strict=False)
                texts = [ParameterText.of(wire_name(node, n), d) for n, d in found]
                self.texts |= {text.name: text for text in texts}
                self._bridge.call_hub(self._reports.set_parameter_texts, texts)

        wanted = {"names": names}
        self._call(f"{node}/describe_parameters", _DESCRIBE, wanted, described)
        self._call(f"{node}/get_parameters", _GET, wanted, got)

    def store(self, node: str, values: Iterable[tuple[str, Any]]) -> None:
        """Store values of a node: name, rcl_interfaces/msg/ParameterValue."""
        received = [to_wire(wire_name(node, name), value_of(v)) for name, v in values]
        for wire in received:
            if len(self.values) < _MAX_VALUES or wire.name in self.values:
                self.values[wire.name] = wire
        self._changed(received)

    def drop(self, node: str, names: Iterable[str]) -> None:
        gone = [WireParameter(wire_name(node, name), None) for name in names]
        for wire in gone:
            self.values.pop(wire.name, None)
        self._changed(gone)

    def _changed(self, values: list[WireParameter]) -> None:
        self._bridge.call_hub(self._reports.parameters_changed, values)

    # -- setting ---------------------------------------------------------------

    def serves(self, node: str) -> bool:
        return node in self._nodes

    def set(self, wire: WireParameter, done: OnEnd) -> None:
        """Set one; calls ``done`` with the reason of a refusal, else with ""."""
        node, _ = split_name(wire.name)
        known = self.values.get(wire.name)
        if known is None and not self._nodes[node].is_known:
            self._fetch(node, lambda reason: self._send(wire, done, reason))
        else:
            self._send(wire, done, "")

    def _send(self, wire: WireParameter, done: OnEnd, failure: str) -> None:
        node, name = split_name(wire.name)
        if failure:
            done(failure)
            return
        try:
            value = from_wire(wire, _current(self.values.get(wire.name)))
            message = self._graph.make_parameter(name, value).to_parameter_msg()
        except NavetteError as error:
            done(str(error))
            return

        def on_response(response: Any, reason: str) -> None:
            if response is None:
                done(f"node {node}: {reason}")
                return
            result = next(iter(response.results), None)
            if result is None or not result.successful:
                done((result.reason if result else "") or "refused")
                return
            # The node's event may arrive late or, for some nodes, never.
            self.store(node, [(name, message.value)])
            done("")

        fields = {"parameters": [message]}
        self._call(f"{node}/set_parameters", _SET, fields, on_response)

    def _call(
        self,
        service: str,
        type_name: str,
        fields: dict[str, Any],
        on_response: OnResponse,
    ) -> None:
        self._service_calls.call(
            service, type_name, fields, on_response, timeout_s=_TIMEOUT_S
        )


def _finish(remote: _Remote, reason: str) -> None:
    waiting, remote.waiting = remote.waiting, []
    for done in waiting:
        done(reason)


def _current(known: WireParameter | None) -> Any:
    """Return a value of the type that :func:`from_wire` converts to."""
    if known is None:
        return None
    if known.kind == "float64":
        return math.nan if known.value is None else float(known.value)
    if known.kind == "float64_array":
        return [0.0]
    return known.value
