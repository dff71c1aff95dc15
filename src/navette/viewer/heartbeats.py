"""Which nodes of other processes live: each is asked a little question all the time.

A node whose program is stopped (Ctrl-Z, SIGSTOP), hangs in a callback or is cut off is
listed in the graph for some seconds more, as if all were well; it does not answer.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum

from navette.viewer.questions import Questions

PERIOD_S = 0.5
SILENT_S = 1.5  # without an answer; at worst two seconds after it froze
_LONGEST_GAP_S = 1.0  # between two beats: longer, and it was us who did not look
_SHARE_S = 0.02  # per node, so that many are asked less often each
_KEPT_S = 600.0  # that a node which is gone is listed
_MOST_GONE = 100

GET = "rcl_interfaces/srv/GetParameters"


class NodeState(StrEnum):
    """How a node is; the words on the socket."""

    ALIVE = "alive"
    SILENT = "silent"
    GONE = "gone"
    UNKNOWN = "unknown"
    """It is there, but has no services that could be asked."""


@dataclass(frozen=True)
class NodeReport:
    """A node and its state; ``since_s`` seconds in silence, or since it is gone."""

    name: str
    state: NodeState
    since_s: float = 0.0


class _Record:
    __slots__ = ("asked_s", "can_answer", "gone_s", "heard_s", "waits")

    def __init__(self, now_s: float) -> None:
        self.heard_s = now_s
        self.asked_s = float("-inf")
        self.gone_s: float | None = None
        self.can_answer = True
        self.waits = False


class Heartbeats:
    """Asks the nodes of other processes whether they live.

    Args:
        questions: asks them.
        now_s: wall time that only grows.
    """

    def __init__(self, questions: Questions, now_s: Callable[[], float]) -> None:
        self._questions = questions
        self._now_s = now_s
        self._records: dict[str, _Record] = {}
        self._last_s = now_s()

    def beat(self, here: set[str], others: Mapping[str, bool]) -> list[NodeReport]:
        """Ask those whose turn it is; how all are, by name.

        Args:
            here: nodes of this process: they live, or this would not run.
            others: nodes of other processes, and whether they can be asked.
        """
        now_s = self._now_s()
        gap_s, self._last_s = now_s - self._last_s, now_s
        if gap_s > _LONGEST_GAP_S:
            for record in self._records.values():
                record.heard_s += gap_s
        self._note_who_is_there(now_s, others)
        period_s = max(PERIOD_S, _SHARE_S * len(others)) * 0.9
        reports = [NodeReport(name, NodeState.ALIVE) for name in here]
        for name, record in self._records.items():
            asks = record.gone_s is None and record.can_answer and not record.waits
            if asks and now_s - record.asked_s >= period_s:
                self._ask(name, record, now_s)
            reports.append(_report(name, record, now_s, max(SILENT_S, 3 * period_s)))
        return sorted(reports, key=lambda report: report.name)

    def rest(self) -> None:
        """Nobody wants to know any more."""
        for name in self._records:
            self._questions.let_go(_service(name))
        self._records.clear()

    def _note_who_is_there(self, now_s: float, others: Mapping[str, bool]) -> None:
        for name, can_answer in others.items():
            record = self._records.get(name)
            if record is None or record.gone_s is not None:
                record = self._records[name] = _Record(now_s)
            record.can_answer = can_answer
        for name, record in self._records.items():
            if name not in others and record.gone_s is None:
                record.gone_s = now_s
                self._questions.let_go(_service(name))
        gone = [(r.gone_s, n) for n, r in self._records.items() if r.gone_s is not None]
        for index, (gone_s, name) in enumerate(sorted(gone, reverse=True)):
            if index >= _MOST_GONE or now_s - gone_s > _KEPT_S:
                del self._records[name]

    def _ask(self, name: str, record: _Record, now_s: float) -> None:
        def answered(response: object, _reason: str) -> None:
            record.waits = False
            if response is not None:
                record.heard_s = self._now_s()

        record.asked_s, record.waits = now_s, True
        self._questions.keep(_service(name))
        self._questions.ask(_service(name), GET, {"names": []}, answered)


def _service(node: str) -> str:
    return f"{node}/get_parameters"


def _report(
    name: str, record: _Record, now_s: float, silent_after_s: float
) -> NodeReport:
    silence_s = now_s - record.heard_s
    if record.gone_s is not None:
        # One that was silent falls out of the graph when its connection times out.
        was_silent = record.gone_s - record.heard_s > silent_after_s
        if record.can_answer and was_silent:
            return NodeReport(name, NodeState.SILENT, silence_s)
        return NodeReport(name, NodeState.GONE, now_s - record.gone_s)
    if not record.can_answer:
        return NodeReport(name, NodeState.UNKNOWN)
    if silence_s > silent_after_s:
        return NodeReport(name, NodeState.SILENT, silence_s)
    return NodeReport(name, NodeState.ALIVE)
