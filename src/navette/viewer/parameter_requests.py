"""Clients' requests about the parameters of all nodes, in this and other processes.

All methods belong to the executor's thread; results are passed to the hub through
the bridge.
"""

from dataclasses import replace
from functools import partial
from typing import Any

from navette.errors import ParameterError
from navette.viewer.frames import WireParameter
from navette.viewer.graph_access import GraphAccess, LocalNode
from navette.viewer.hub import Hub
from navette.viewer.parameters import (
    ParameterText,
    from_wire,
    split_name,
    to_wire,
    value_of,
    wire_name,
)
from navette.viewer.remote_parameters import OnEnd, RemoteParameters
from navette.viewer.thread_bridge import ThreadBridge


class ParameterRequests:
    """Executes clients' requests about parameters.

    Args:
        remote: parameters of the nodes of other processes.
    """

    def __init__(
        self,
        hub: Hub,
        *,
        bridge: ThreadBridge,
        graph: GraphAccess,
        remote: RemoteParameters,
    ) -> None:
        self._hub = hub
        self._bridge = bridge
        self._graph = graph
        self._remote = remote
        #: Requests (client, names, id) that wait for the nodes' responses.
        self._waiting: list[tuple[int, tuple[str, ...], str | None]] = []

    def get(self, client: int, names: tuple[str, ...], request_id: str | None) -> None:
        """Send the named parameters, or all, once all nodes have responded.

        Unknown names and nodes that do not respond are omitted.
        """
        for name in names:
            try:
                split_name(name)
            except ParameterError as error:
                self._bridge.call_hub(self._hub.send_status, client, str(error))
                break
        self._waiting.append((client, names, request_id))
        if len(self._waiting) == 1:
            self._remote.fetch(self._send_to_waiting)

    def _send_to_waiting(self) -> None:
        waiting, self._waiting = self._waiting, []
        found = self._all_parameters()
        for client, names, request_id in waiting:
            self._send(client, names, request_id, found)
            self._bridge.call_hub(self._hub.done, client)

    def set(
        self,
        client: int,
        parameters: tuple[WireParameter, ...],
        request_id: str | None,
    ) -> None:
        """Set parameters of any nodes; the client receives the reason of refusals."""
        left = len(parameters)

        def end() -> None:
            # The current values show what was set and what was refused.
            if request_id is not None:
                names = tuple(parameter.name for parameter in parameters)
                self._send(client, names, request_id, self._all_parameters())
            self._bridge.call_hub(self._hub.done, client)

        def one_is_done(name: str, reason: str) -> None:
            nonlocal left
            left -= 1
            if reason:
                # The page finds the parameter by the first words.
                is_whole = reason.startswith("parameter ") and name in reason
                text = reason if is_whole else f"parameter {name!r:.120}: {reason}"
                self._bridge.call_hub(self._hub.send_status, client, text)
            if not left:
                end()

        for wire in parameters:
            self._set_one(wire, partial(one_is_done, wire.name))
        if not parameters:
            end()

    def describe(self, client: int) -> None:
        texts = [text for node in self._graph.local_nodes() for text in _texts_of(node)]
        texts += self._remote.texts.values()
        self._bridge.call_hub(self._hub.reports.set_parameter_texts, texts, client)
        self._bridge.call_hub(self._hub.done, client)

    def on_event(self, event: Any) -> None:
        """Forward an rcl_interfaces/msg/ParameterEvent to the clients."""
        changed = (*event.new_parameters, *event.changed_parameters)
        values = [(each.name, each.value) for each in changed]
        deleted = [each.name for each in event.deleted_parameters]
        if self._node_here(event.node) is None:
            self._remote.store(event.node, values)
            self._remote.drop(event.node, deleted)
            return
        changes = [to_wire(wire_name(event.node, n), value_of(v)) for n, v in values]
        changes += [WireParameter(wire_name(event.node, n), None) for n in deleted]
        self._bridge.call_hub(self._hub.reports.parameters_changed, changes)

    def _all_parameters(self) -> dict[str, WireParameter]:
        return self._remote.values | {
            parameter.name: parameter
            for node in self._graph.local_nodes()
            for parameter in _parameters_of(node)
        }

    def _send(
        self,
        client: int,
        names: tuple[str, ...],
        request_id: str | None,
        found: dict[str, WireParameter],
    ) -> None:
        wanted = [n if n.startswith("/") else f"/{n}" for n in names] or list(found)
        values = [found[name] for name in wanted if name in found]
        self._bridge.call_hub(self._hub.reports.parameters, client, values, request_id)

    def _set_one(self, wire: WireParameter, done: OnEnd) -> None:
        """Call ``done`` with the reason if the parameter was not set, else with ""."""
        try:
            node_name, name = split_name(wire.name)
            node = self._node_here(node_name)
            if node is not None and node.has_parameter(name):
                self._set_here(node, name, wire)
            elif self._remote.serves(node_name):
                whole = replace(wire, name=wire_name(node_name, name))
                self._remote.set(whole, done)
                return
            else:
                raise ParameterError("no node has this parameter")
        except ParameterError as error:
            done(str(error))
        else:
            done("")

    def _set_here(self, node: LocalNode, name: str, wire: WireParameter) -> None:
        """Set it; raises ParameterError with the node's reason."""
        value = from_wire(wire, node.get_parameter(name).value)
        (result,) = node.set_parameters([self._graph.make_parameter(name, value)])
        if not result.successful:
            raise ParameterError(result.reason or "refused")

    def _node_here(self, full_name: str) -> LocalNode | None:
        for node in self._graph.local_nodes():
            if node.get_fully_qualified_name() == full_name:
                return node
        return None


def _parameters_of(node: LocalNode) -> list[WireParameter]:
    own = node.get_fully_qualified_name()
    found = node.get_parameters_by_prefix("").values()
    return [to_wire(wire_name(own, each.name), each.value) for each in found]


def _texts_of(node: LocalNode) -> list[ParameterText]:
    own = node.get_fully_qualified_name()
    names = list(node.get_parameters_by_prefix(""))
    found = zip(names, node.describe_parameters(names), strict=True)
    return [ParameterText.of(wire_name(own, name), text) for name, text in found]
