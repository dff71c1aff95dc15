"""Parameters of nodes of other processes, by their ROS 2 parameter services.

Listed, read and described once, as soon as a client wants to see parameters; from then
on ``/parameter_events`` tells what changes. Nothing here waits.
"""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from navette.errors import NavetteError
from navette.viewer.frames import WireParameter
from navette.viewer.parameters import (
    ParameterText,
    from_wire,
    split_name,
    to_wire,
    value_of,
    wire_name,
)
from navette.viewer.questions import Answered, Questions

LIST = "rcl_interfaces/srv/ListParameters"
_GET = "rcl_interfaces/srv/GetParameters"
_DESCRIBE = "rcl_interfaces/srv/DescribeParameters"
_SET = "rcl_interfaces/srv/SetParameters"

# Nobody has as many, except to do harm.
_MOST_NAMES = 1000
_MOST_TOLD = 10_000
_PATIENCE_S = 2.0  # with a node that is busy
_AGAIN_S = 5.0  # after a question, until a node that did not answer is asked again

Encode = Callable[[str, Any], Any]
"""Name and value → rcl_interfaces/msg/Parameter; raises NavetteError for no value."""


@dataclass
class _Remote:
    """A node elsewhere; ``gid`` tells it from its successor of the same name."""

    gid: bytes
    is_known: bool = False
    asked_s: float | None = None
    waiting: list[Callable[[str], None]] = field(default_factory=list)


class RemoteParameters:
    """What is known of the parameters of nodes that are not here.

    Args:
        questions: asks their services.
        encode: makes the message of a value.
        now_s: wall time that only grows.
        changed: takes values that are new, other than before, or (None) gone.
        described: takes texts and ranges that are new.
    """

    def __init__(
        self,
        questions: Questions,
        encode: Encode,
        now_s: Callable[[], float],
        changed: Callable[[list[WireParameter]], None],
        described: Callable[[list[ParameterText]], None],
    ) -> None:
        self._questions = questions
        self._encode = encode
        self._now_s = now_s
        self._changed = changed
        self._described = described
        self._nodes: dict[str, _Remote] = {}
        #: Full name of the parameter → its value; also of nodes that only told it.
        self.values: dict[str, WireParameter] = {}
        self.texts: dict[str, ParameterText] = {}

    # -- who is there ----------------------------------------------------------

    def set_nodes(self, serving: Mapping[str, bytes]) -> None:
        """Nodes that serve their parameters, with the id of that service.

        What those that are gone had is forgotten.
        """
        for name, remote in list(self._nodes.items()):
            if serving.get(name) != remote.gid:
                del self._nodes[name]
                self._forget(name)
                _tell(remote, f"node {name} is gone")
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
        """Read the parameters of the nodes that are not known yet.

        ``done`` is called when all of them have answered or cannot; without it, those
        that did not answer a moment ago are left alone.
        """
        now_s = self._now_s()
        unknown = [
            name
            for name, remote in self._nodes.items()
            if not remote.is_known
            and (done or remote.asked_s is None or now_s - remote.asked_s > _AGAIN_S)
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

    def _fetch(self, node: str, done: Callable[[str], None]) -> None:
        """``done`` takes why it did not work; empty where it did."""
        remote = self._nodes[node]
        remote.waiting.append(done)
        if len(remote.waiting) > 1:  # under way
            return
        remote.asked_s = self._now_s()

        def listed(response: Any, reason: str) -> None:
            if self._nodes.get(node) is not remote:
                return
            if response is None:
                _tell(remote, f"node {node}: {reason}")
            else:
                self._read(node, remote, list(response.result.names)[:_MOST_NAMES])

        self._ask(f"{node}/list_parameters", LIST, {}, listed)

    def _read(self, node: str, remote: _Remote, names: list[str]) -> None:
        def got(response: Any, reason: str) -> None:
            if self._nodes.get(node) is not remote:
                return
            if response is None:
                _tell(remote, f"node {node}: {reason}")
                return
            remote.is_known = True
            self.take(node, zip(names, response.values, strict=False))
            _tell(remote, "")

        def described(response: Any, _reason: str) -> None:
            # Without texts and ranges they can be shown and set all the same.
            if response is not None and self._nodes.get(node) is remote:
                found = zip(names, response.descriptors, strict=False)
                texts = [ParameterText.of(wire_name(node, n), d) for n, d in found]
                self.texts |= {text.name: text for text in texts}
                self._described(texts)

        wanted = {"names": names}
        self._ask(f"{node}/describe_parameters", _DESCRIBE, wanted, described)
        self._ask(f"{node}/get_parameters", _GET, wanted, got)

    def take(self, node: str, values: Iterable[tuple[str, Any]]) -> None:
        """Parameters as a node says them: name, rcl_interfaces/msg/ParameterValue."""
        told = [to_wire(wire_name(node, name), value_of(v)) for name, v in values]
        for wire in told:
            if len(self.values) < _MOST_TOLD or wire.name in self.values:
                self.values[wire.name] = wire
        self._changed(told)

    def drop(self, node: str, names: Iterable[str]) -> None:
        """Parameters that a node says are deleted."""
        gone = [WireParameter(wire_name(node, name), None) for name in names]
        for wire in gone:
            self.values.pop(wire.name, None)
        self._changed(gone)

    # -- setting ---------------------------------------------------------------

    def serves(self, node: str) -> bool:
        """Whether the parameters of that node can be asked for and set."""
        return node in self._nodes

    def set(self, wire: WireParameter, done: Callable[[str], None]) -> None:
        """Set one; ``done`` takes why it was not set, in the node's words."""
        node, _ = split_name(wire.name)
        known = self.values.get(wire.name)
        if known is None and not self._nodes[node].is_known:
            self._fetch(node, lambda reason: self._send(wire, done, reason))
        else:
            self._send(wire, done, "")

    def _send(
        self, wire: WireParameter, done: Callable[[str], None], trouble: str
    ) -> None:
        node, name = split_name(wire.name)
        if trouble:
            done(trouble)
            return
        try:
            value = from_wire(wire, _current(self.values.get(wire.name)))
            message = self._encode(name, value)
        except NavetteError as error:
            done(str(error))
            return

        def answered(response: Any, reason: str) -> None:
            if response is None:
                done(f"node {node}: {reason}")
                return
            result = next(iter(response.results), None)
            if result is None or not result.successful:
                done((result.reason if result else "") or "refused")
                return
            # The node's event may be late, or (not every node has them) never come.
            self.take(node, [(name, message.value)])
            done("")

        fields = {"parameters": [message]}
        self._ask(f"{node}/set_parameters", _SET, fields, answered)

    def _ask(
        self, service: str, type_name: str, fields: dict[str, Any], answered: Answered
    ) -> None:
        self._questions.ask(
            service, type_name, fields, answered, patience_s=_PATIENCE_S
        )


def _tell(remote: _Remote, reason: str) -> None:
    waiting, remote.waiting = remote.waiting, []
    for done in waiting:
        done(reason)


def _current(known: WireParameter | None) -> Any:
    """A value as :func:`from_wire` wants it, to tell what kind it is."""
    if known is None:
        return None
    if known.kind == "float64":
        return math.nan if known.value is None else float(known.value)
    if known.kind == "float64_array":
        return [0.0]
    return known.value
