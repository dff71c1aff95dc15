"""The clock of a process that takes part in a simulator's lock-step."""

from navette.errors import LockStepError
from navette.runtime.lockstep.clock import LIMIT_S, REPEAT_S, LockStepClock
from navette.runtime.wakeup import Wakeup
from navette.transports.lockstep import Participants, StepGrant, StepReport, StepWire


class Participant(LockStepClock):
    """Virtual time that advances when the coordinator grants it.

    Time stays at zero until a simulator names a node of this process (``--lockstep``).
    """

    def __init__(self, limit_s: float = LIMIT_S) -> None:
        super().__init__(limit_s)
        self._coordinator = ""
        self._received: StepGrant | None = None
        self._reported: StepReport | None = None

    def join(self, wire: StepWire) -> None:
        self._wire = wire
        wire.subscribe_grants(self._on_grant)

    def _on_grant(self, grant: StepGrant) -> None:
        """Store a grant of this run's coordinator; called in another thread."""
        if self._coordinator not in ("", grant.coordinator) or self._is_old(grant):
            return
        self._received = grant
        self._wake()

    def _wait_for_others(self, participants: Participants, wakeup: Wakeup) -> None:
        grant = self._received
        if grant is not None:
            self._received = None  # the next grant follows our report
            if not self._is_old(grant):
                self._check_and_accept(grant)
            return
        # Not earlier: samples to other processes may still be on their way.
        is_gone = self._coordinator not in participants.seen or not self._remaining_s
        if self._is_over and is_gone:
            self.on_end()
            return
        report = self._own_report(participants)
        if self._is_new(report):
            self._reported = report
            self.wire.send_report(report)
        if not self.step:
            named = ", ".join(participants.nodes) or "a process without nodes"
            self._log_waiting(f"{named}: waiting for a simulator with --lockstep")
        if not wakeup.wait(REPEAT_S):
            self._reported = None

    def _is_old(self, grant: StepGrant) -> bool:
        """Return whether the grant is a repetition."""
        return bool(self._coordinator) and grant.step <= self.step

    def _is_new(self, report: StepReport) -> bool:
        """Return whether the step or the endpoints changed since the last report."""
        before = self._reported
        return before is None or (
            (report.step, report.nodes, report.own, report.seen)
            != (before.step, before.nodes, before.own, before.seen)
        )

    def _check_and_accept(self, grant: StepGrant) -> None:
        if self.wire.session not in grant.roster:
            names = ", ".join(self.wire.participants().nodes)
            raise LockStepError(
                f"lock-step: the simulator does not wait for {names}: the run began "
                "earlier, or --lockstep does not name the node"
            )
        if grant.step != self.step + 1 or grant.until_ns < self._granted_ns:
            raise LockStepError(
                f"lock-step: received step {grant.step} after step {self.step}"
            )
        self._coordinator = grant.coordinator
        self._accept(grant)

    def _check_present(self, participants: Participants) -> None:
        if not self._coordinator or self._coordinator in participants.seen:
            return
        if self._received is None:  # else its last grant arrived before it ended
            raise LockStepError(
                f"lock-step: the simulator is gone, at {self.now_ns / 1e9:g} s"
            )
