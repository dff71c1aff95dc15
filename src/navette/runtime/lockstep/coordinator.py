"""The simulator's clock: advances when all named nodes have finished the step."""

import logging
import math
from collections.abc import Sequence

from navette.errors import InvalidValueError, LockStepError
from navette.runtime.clock import (
    ContextClock,
    PacedClock,
    Stopwatch,
    VirtualClock,
)
from navette.runtime.lockstep.clock import LIMIT_S, REPEAT_S, LockStepClock
from navette.runtime.wakeup import Wakeup
from navette.transports.lockstep import (
    Participants,
    Sent,
    StepGrant,
    StepReport,
    StepWire,
)

STEP_S = 0.01
_MAX_SESSIONS = 10_000

_log = logging.getLogger(__name__)


class Coordinator(LockStepClock):
    """Grants time to the processes of the named nodes, step by step.

    The run begins when all nodes are there and all processes know each other's
    endpoints. It ends with an error that names the nodes that are gone or take longer
    than the limit for a step.

    Args:
        nodes: full names of nodes of other processes; the first slash is optional.
        step_s: virtual time of a step: the longest time that a message takes from
            process to process.
        speed: maximum real-time factor.
        until_s: virtual time at which the run ends for all processes; None: never.
        limit_s: wall time that a process may take for a step.

    Raises:
        InvalidValueError: no nodes, a node named twice, or a value out of range.
    """

    def __init__(
        self,
        nodes: Sequence[str],
        *,
        step_s: float = STEP_S,
        speed: float = math.inf,
        until_s: float | None = None,
        limit_s: float = LIMIT_S,
    ) -> None:
        super().__init__(limit_s)
        self.nodes = tuple("/" + name.strip().lstrip("/") for name in nodes)
        if not self.nodes or "/" in self.nodes or len(set(self.nodes)) < len(nodes):
            raise InvalidValueError(
                f"lock-step with {', '.join(nodes) or 'no nodes'}: expected names of "
                "nodes, each once"
            )
        self._step_ns = _nanoseconds(step_s, "lock-step: step")
        self._end_ns = None
        if until_s is not None:
            self._end_ns = _nanoseconds(until_s, "lock-step: end")
        self._pace: ContextClock = VirtualClock()
        if speed != math.inf:
            self._pace = PacedClock(speed)
        self._reports: dict[str, StepReport] = {}
        #: Session → its named nodes; empty before the first step.
        self._roster: dict[str, tuple[str, ...]] = {}
        self._last: StepGrant | None = None
        self._run = Stopwatch()

    def join(self, wire: StepWire) -> None:
        self._wire = wire
        wire.subscribe_reports(self._on_report)

    def _on_report(self, session: str, report: StepReport) -> None:
        """Store a report; called in another thread, also with forged sessions."""
        if session not in self._reports and len(self._reports) >= _MAX_SESSIONS:
            return
        self._reports[session] = report
        if all(self._is_done(each) for each in self._roster):
            self._wake()

    def _is_done(self, session: str) -> bool:
        report = self._reports.get(session)
        return report is not None and report.step == self.step

    def _wait_for_others(self, participants: Participants, wakeup: Wakeup) -> None:
        if self._is_over:
            self._end(participants, wakeup)
            return
        reports = dict(self._reports)
        if not self.step:
            roster, problems = self._gathered(participants, reports)
        else:
            roster = self._roster
            problems = [_named(roster, s) for s in roster if not self._is_done(s)]
        problems = problems or self._incomplete(participants, reports, roster)
        if problems:
            self._wait(problems, wakeup)
        elif self._pace.go_to(self._granted_ns, wakeup):
            self._roster = roster
            self._grant(reports)

    def _end(self, participants: Participants, wakeup: Wakeup) -> None:
        """End when all have received the last grant; they end when we are gone."""
        there = [session for session in self._roster if session in participants.seen]
        busy = [_named(self._roster, s) for s in there if not self._is_done(s)]
        if busy:
            self._wait(busy, wakeup)
        else:
            self.on_end()

    def _wait(self, problems: list[str], wakeup: Wakeup) -> None:
        """Wait for a report or a change of the participants, within the limit.

        Repeated reports do not extend the limit.
        """
        listed = "; ".join(sorted(problems)[:20])
        if self._last is None:
            self._log_waiting(f"waiting for {listed}")
            wakeup.wait(REPEAT_S)
        elif self._remaining_s <= 0.0:
            raise LockStepError(
                f"lock-step: no response within {self.limit_s:g} s at "
                f"{self.now_ns / 1e9:g} s: {listed}"
            )
        elif not wakeup.wait(min(REPEAT_S, self._remaining_s)):
            self.wire.send_grant(self._last)

    # -- participants --------------------------------------------------------

    def _gathered(
        self, participants: Participants, reports: dict[str, StepReport]
    ) -> tuple[dict[str, tuple[str, ...]], list[str]]:
        """Return session → its named nodes, and what is missing."""
        here = {s: r for s, r in reports.items() if s in participants.seen}
        roster: dict[str, tuple[str, ...]] = {}
        problems: list[str] = []
        for name in self.nodes:
            having = [session for session, r in here.items() if name in r.nodes]
            if len(having) > 1:
                raise LockStepError(f"lock-step: {len(having)} processes have {name}")
            if having:
                roster[having[0]] = (*roster.get(having[0], ()), name)
            elif name in participants.others:
                problems.append(f"{name} (running without NAVETTE_LOCKSTEP=follow)")
            else:
                problems.append(name)
        idle = [n for s, r in here.items() if s not in roster for n in r.nodes]
        if problems and idle:
            listed = ", ".join(sorted(idle)[:20])
            problems.append(f"not named, but NAVETTE_LOCKSTEP=follow: {listed}")
        return roster, problems

    def _check_present(self, participants: Participants) -> None:
        gone = [
            _named(self._roster, s) for s in self._roster if s not in participants.seen
        ]
        if gone:
            raise LockStepError(
                f"lock-step: gone at {self.now_ns / 1e9:g} s: {', '.join(gone)}"
            )

    def _incomplete(
        self,
        participants: Participants,
        reports: dict[str, StepReport],
        roster: dict[str, tuple[str, ...]],
    ) -> list[str]:
        """Return which processes do not know all endpoints of another one yet."""
        own = {s: reports[s].own for s in roster}
        own[self.wire.session] = participants.own
        seen = {s: reports[s].seen for s in roster}
        seen[self.wire.session] = participants.seen
        return [
            f"{_named(roster, one)} to see all of {_named(roster, other)}"
            for one in own
            for other in own
            if one != other and seen[one].get(other) != own[other]
        ]

    # -- steps -----------------------------------------------------------------

    def _grant(self, reports: dict[str, StepReport]) -> None:
        sent: dict[bytes, Sent] = dict(self.traffic.sent_counter.changed())
        for session in self._roster:
            sent.update(reports[session].sent)
        is_last = self._end_ns is not None and self._granted_ns >= self._end_ns
        if not self.step:
            self._run = Stopwatch()
            _log.info("lock-step: begins, with %s", ", ".join(self.nodes))
        if is_last:
            self._log_end()
        until_ns = self._granted_ns + (0 if is_last else self._step_ns)
        if self._end_ns is not None:
            until_ns = min(until_ns, self._end_ns)
        grant = StepGrant(
            coordinator=self.wire.session,
            step=self.step + 1,
            until_ns=until_ns,
            roster=tuple(self._roster),
            sent=sent,
            is_last=is_last,
        )
        self._last = grant
        self.wire.send_grant(grant)
        self._accept(grant)

    def _log_end(self) -> None:
        wall_s, run_s = self._run.elapsed_s, self._granted_ns / 1e9
        _log.info(
            "lock-step: %d steps to %g s in %.1f s: %.1f × real time",
            self.step,
            run_s,
            wall_s,
            run_s / wall_s,
        )


def _named(roster: dict[str, tuple[str, ...]], session: str) -> str:
    return ", ".join(roster.get(session, ("the simulator",)))


def _nanoseconds(seconds: float, what: str) -> int:
    if not 1e-6 <= seconds <= 1e9:
        raise InvalidValueError(f"{what} of {seconds!r} s: expected 0.000001 to 1e9 s")
    return round(seconds * 1e9)
