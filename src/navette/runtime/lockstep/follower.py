"""The clock of a process that the simulator waits for."""

from navette.errors import LockStepError
from navette.runtime.clock import Wakeup
from navette.runtime.lockstep.clock import AGAIN_S, LIMIT_S, LockStepClock
from navette.transports.lockstep import Census, Grant, Report, StepWire


class Follower(LockStepClock):
    """Virtual time that goes on when the conductor grants it.

    It stands at zero until a simulator with ``--lockstep`` names a node of this
    process.
    """

    def __init__(self, limit_s: float = LIMIT_S) -> None:
        super().__init__(limit_s)
        self._conductor = ""
        self._granted: Grant | None = None  # as it came
        self._reported: Report | None = None

    def join(self, wire: StepWire) -> None:
        self._wire = wire
        wire.hear_grants(self._on_grant)

    def _on_grant(self, grant: Grant) -> None:
        """In another thread; what another conductor says is not for us."""
        if self._conductor not in ("", grant.conductor) or self._is_old(grant):
            return
        self._granted = grant
        self._wake()

    def _await_others(self, census: Census, wakeup: Wakeup) -> None:
        grant = self._granted
        if grant is not None:
            self._granted = None  # no other comes before our report
            if not self._is_old(grant):
                self._follow(grant)
            return
        # Not sooner: what was sent may be on its way to the others still.
        is_gone = self._conductor not in census.seen or not self._patience_s
        if self._is_over and is_gone:
            self.on_end()
            return
        report = self._own_report(census)
        if self._is_news(report):
            self._reported = report
            self.wire.report(report)
        if not self.step:
            named = ", ".join(census.nodes) or "a process without nodes"
            self._say(f"{named}: waiting for a simulator with --lockstep")
        if not wakeup.wait(AGAIN_S):
            self._reported = None

    def _is_old(self, grant: Grant) -> bool:
        """Whether it was said again though it was heard."""
        return bool(self._conductor) and grant.step <= self.step

    def _is_news(self, report: Report) -> bool:
        """In a step the conductor needs no other report, unless endpoints changed."""
        before = self._reported
        return before is None or (
            (report.step, report.nodes, report.own, report.seen)
            != (before.step, before.nodes, before.own, before.seen)
        )

    def _follow(self, grant: Grant) -> None:
        if self.wire.session not in grant.roster:
            names = ", ".join(self.wire.census().nodes)
            raise LockStepError(
                f"lock-step: the simulator does not wait for {names}: it began before, "
                "or its --lockstep does not name it"
            )
        if grant.step != self.step + 1 or grant.until_ns < self._granted_ns:
            raise LockStepError(
                f"lock-step: after step {self.step} came step {grant.step}"
            )
        self._conductor = grant.conductor
        self._take(grant)

    def _check_there(self, census: Census) -> None:
        if not self._conductor or self._conductor in census.seen:
            return
        if self._granted is None:  # its last grant came before it went
            raise LockStepError(
                f"lock-step: the simulator is gone, at {self.now_ns / 1e9:g} s"
            )
