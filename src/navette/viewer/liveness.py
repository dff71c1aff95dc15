"""Liveness of the nodes of other processes, probed by small service calls.

A node whose program is stopped (Ctrl-Z, SIGSTOP), blocks in a callback or is
disconnected stays in the graph for some seconds, but it does not respond.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from navette.viewer.service_calls import ServiceCalls
from navette.viewer.wall_clock import WallClock

PERIOD_S = 0.5
SILENT_S = 1.5  # without a response; detected at most two seconds after a freeze
_LONGEST_GAP_S = 1.0  # between two steps; a longer one means that this process slept
_SHARE_S = 0.02  # period per node: with many nodes each is probed less often
_KEPT_S = 600.0  # for which a node that left the graph stays listed
_MOST_GONE = 100

GET = "rcl_interfaces/srv/GetParameters"


class NodeState(StrEnum):
    """State of a node; the values are those sent to clients."""

    ALIVE = "alive"
    SILENT = "silent"
    GONE = "gone"
    UNKNOWN = "unknown"
    """In the graph, but without services to probe."""


@dataclass(frozen=True)
class NodeReport:
    """A node's state; ``since_s`` seconds without a response, or since it left."""

    name: str
    state: NodeState
    since_s: float = 0.0


@dataclass
class _Record:
    responded_s: float
    probed_s: float = float("-inf")
    gone_s: float | None = None
    can_answer: bool = True
    is_pending: bool = False


class LivenessProbe:
    """Probes the nodes of other processes."""

    def __init__(self, service_calls: ServiceCalls, clock: WallClock) -> None:
        self._service_calls = service_calls
        self._clock = clock
        self._records: dict[str, _Record] = {}
        self._last_s = clock.now_s

    def step(self, here: set[str], others: Mapping[str, bool]) -> list[NodeReport]:
        """Probe the nodes that are due; return the state of each, sorted by name.

        Args:
            here: nodes of this process; they are alive, since this code runs.
            others: nodes of other processes, and whether they have services to probe.
        """
        now_s = self._clock.now_s
        gap_s, self._last_s = now_s - self._last_s, now_s
        if gap_s > _LONGEST_GAP_S:
            for record in self._records.values():
                record.responded_s += gap_s
        self._update_records(now_s, others)
        period_s = max(PERIOD_S, _SHARE_S * len(others)) * 0.9
        reports = [NodeReport(name, NodeState.ALIVE) for name in here]
        for name, record in self._records.items():
            is_idle = record.gone_s is None and not record.is_pending
            is_due = now_s - record.probed_s >= period_s
            if is_idle and record.can_answer and is_due:
                self._probe(name, record, now_s)
            reports.append(_report(name, record, now_s, max(SILENT_S, 3 * period_s)))
        return sorted(reports, key=lambda report: report.name)

    def reset(self) -> None:
        """Forget all nodes and release their service clients."""
        for name in self._records:
            self._service_calls.release(_service(name))
        self._records.clear()

    def _update_records(self, now_s: float, others: Mapping[str, bool]) -> None:
        for name, can_answer in others.items():
            record = self._records.get(name)
            if record is None or record.gone_s is not None:
                record = self._records[name] = _Record(now_s)
            record.can_answer = can_answer
        for name, record in self._records.items():
            if name not in others and record.gone_s is None:
                record.gone_s = now_s
                self._service_calls.release(_service(name))
        gone = [(r.gone_s, n) for n, r in self._records.items() if r.gone_s is not None]
        for index, (gone_s, name) in enumerate(sorted(gone, reverse=True)):
            if index >= _MOST_GONE or now_s - gone_s > _KEPT_S:
                del self._records[name]

    def _probe(self, name: str, record: _Record, now_s: float) -> None:
        def on_response(response: object, _reason: str) -> None:
            record.is_pending = False
            if response is not None:
                record.responded_s = self._clock.now_s

        record.probed_s, record.is_pending = now_s, True
        self._service_calls.retain(_service(name))
        self._service_calls.call(_service(name), GET, {"names": []}, on_response)


def _service(node: str) -> str:
    return f"{node}/get_parameters"


def _report(
    name: str, record: _Record, now_s: float, silent_after_s: float
) -> NodeReport:
    silence_s = now_s - record.responded_s
    if record.gone_s is not None:
        # A silent node leaves the graph when its connection times out.
        was_silent = record.gone_s - record.responded_s > silent_after_s
        if record.can_answer and was_silent:
            return NodeReport(name, NodeState.SILENT, silence_s)
        return NodeReport(name, NodeState.GONE, now_s - record.gone_s)
    if not record.can_answer:
        return NodeReport(name, NodeState.UNKNOWN)
    if silence_s > silent_after_s:
        return NodeReport(name, NodeState.SILENT, silence_s)
    return NodeReport(name, NodeState.ALIVE)
