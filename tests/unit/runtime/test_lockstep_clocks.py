"""The two clocks of a lock-step on a wire that the test controls."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from lockstep_fakes import Publishers
from navette.errors import InvalidValueError, LockStepError
from navette.runtime import Context, Executor, SystemClock, VirtualClock
from navette.runtime.clock import Wakeup
from navette.runtime.lockstep import Coordinator, LockStepClock, Participant
from navette.runtime.network import chosen_transport
from navette.transports import Endpoint, EndpointKind, EndpointQos
from navette.transports.lockstep import (
    Participants,
    Sent,
    StepGrant,
    StepReport,
    StepWire,
    SubscriptionInfo,
)

SIM, ONE, TWO = "51", "01", "02"
MS = 10**6


class FakeWire(StepWire):
    """Records what is sent; the test calls what is received."""

    def __init__(self, session: str, participants: Participants) -> None:
        self._session = session
        self.present = participants
        self.reports: list[StepReport] = []
        self.grants: list[StepGrant] = []
        self.on_report: Callable[[str, StepReport], None]
        self.on_grant: Callable[[StepGrant], None]

    @property
    def session(self) -> str:
        return self._session

    def participants(self) -> Participants:
        return self.present

    def send_report(self, report: StepReport) -> None:
        self.reports.append(report)

    def send_grant(self, grant: StepGrant) -> None:
        self.grants.append(grant)

    def subscribe_reports(self, callback: Callable[[str, StepReport], None]) -> None:
        self.on_report = callback

    def subscribe_grants(self, callback: Callable[[StepGrant], None]) -> None:
        self.on_grant = callback


class FakeWakeup(Wakeup):
    """Every wait ends at once: by an event, or (``timed_out``) by its timeout."""

    def __init__(self, *, timed_out: bool = False) -> None:
        super().__init__()
        self._timed_out = timed_out

    def wait(self, timeout_s: float | None) -> bool:
        return self.is_pending or not (self._timed_out or timeout_s == 0.0)


def turns(
    clock: LockStepClock,
    target_ns: int | None = None,
    times: int = 1,
    *,
    timed_out: bool = False,
) -> None:
    """Do what a loop without events before ``target_ns`` does."""
    for _ in range(times):
        clock.go_to(target_ns, FakeWakeup(timed_out=timed_out))


# -- participant ---------------------------------------------------------------


class ParticipantBench:
    """A participant with node /planner, and what it sends."""

    def __init__(self, limit_s: float = 30.0) -> None:
        self.clock = Participant(limit_s)
        self.wire = FakeWire(ONE, Participants(("/planner",), ("/sim",), 5, {SIM: 7}))
        self.clock.join(self.wire)

    def granted(self, step: int, until_ns: int, **more: Any) -> None:
        sent = more.pop("sent", {})
        grant = StepGrant(SIM, step, until_ns, (ONE, TWO), sent)
        self.wire.on_grant(replace(grant, **more))


def test_a_participant_stays_at_zero_and_reports_its_nodes() -> None:
    bench = ParticipantBench()
    turns(bench.clock, 3 * MS, times=3)
    assert bench.clock.now_ns == 0
    assert bench.wire.reports == [StepReport(0, ("/planner",), 5, {SIM: 7}, {})]


def test_a_participant_reports_new_endpoints() -> None:
    bench = ParticipantBench()
    turns(bench.clock)
    bench.wire.present = replace(bench.wire.present, seen={SIM: 8})
    turns(bench.clock)
    assert [report.seen for report in bench.wire.reports] == [{SIM: 7}, {SIM: 8}]


def test_a_participant_runs_the_granted_time_only() -> None:
    bench = ParticipantBench()
    bench.granted(1, 10 * MS)
    turns(bench.clock, 4 * MS)
    assert bench.clock.now_ns == 0  # the grant is taken in
    wakeup = FakeWakeup()
    assert bench.clock.go_to(4 * MS, wakeup)
    assert bench.clock.now_ns == 4 * MS
    assert bench.clock.go_to(10 * MS, wakeup)
    assert not bench.clock.go_to(11 * MS, wakeup)
    assert bench.clock.now_ns == 10 * MS
    assert bench.wire.reports[-1].step == 1


def test_a_participant_reports_its_samples_once_a_step() -> None:
    bench = ParticipantBench()
    sent = bench.clock.traffic.sent_counter.open(bytes(16), "/planner")
    sent.add(1)
    turns(bench.clock)
    assert bench.wire.reports[-1].sent == {bytes(16): Sent("/planner", 1, 1, 1)}
    bench.granted(1, 10 * MS, sent=bench.wire.reports[-1].sent)
    turns(bench.clock, times=3)
    assert [(report.step, dict(report.sent)) for report in bench.wire.reports] == [
        (0, {bytes(16): Sent("/planner", 1, 1, 1)}),
        (1, {}),
    ]


def buffer_one(clock: LockStepClock, got: list[Any]) -> tuple[bytes, Any]:
    """Open a subscription with one remote publisher before the first step."""
    gid = bytes(15) + b"g"
    endpoint = Endpoint(
        EndpointKind.PUBLISHER, "/t", "p/msg/T", EndpointQos(), "n", "/", gid, "h"
    )
    info = SubscriptionInfo("/t", Publishers({gid: endpoint}), sink=got.append, depth=1)
    return gid, clock.traffic.buffer.open(info)


def test_a_step_begins_when_its_samples_have_arrived() -> None:
    bench, got = ParticipantBench(), list[Any]()
    gid, subscription = buffer_one(bench.clock, got)
    bench.granted(1, 10 * MS, sent={gid: Sent("/n", 1, 0, 0)})
    turns(bench.clock, times=2)
    bench.granted(2, 20 * MS, sent={gid: Sent("/n", 1, 1, 1)})
    turns(bench.clock)
    assert bench.clock.step == 1
    subscription.take(gid, ("message", 3 * MS, 0, 1))
    assert got == []
    turns(bench.clock)
    assert bench.clock.step == 2
    assert got == [("message", 3 * MS, 10 * MS, 1)]
    assert bench.clock.now_ns == 10 * MS


def test_samples_that_do_not_arrive_are_named() -> None:
    bench = ParticipantBench(limit_s=0.0)
    gid, _ = buffer_one(bench.clock, [])
    bench.granted(1, 10 * MS, sent={gid: Sent("/n", 1, 0, 0)})
    turns(bench.clock, times=2)
    bench.granted(2, 20 * MS, sent={gid: Sent("/n", 1, 3, 3)})
    turns(bench.clock)
    with pytest.raises(LockStepError, match=r"0\.01 s: 3 of /t by /n"):
        turns(bench.clock)


def test_a_participant_that_is_not_named_is_an_error() -> None:
    bench = ParticipantBench()
    bench.granted(1, 10 * MS, roster=(TWO,))
    with pytest.raises(LockStepError, match="does not wait for /planner"):
        turns(bench.clock)


def test_a_skipped_step_is_an_error() -> None:
    bench = ParticipantBench()
    bench.granted(2, 10 * MS)
    with pytest.raises(LockStepError, match="received step 2 after step 0"):
        turns(bench.clock)


def test_a_participant_ignores_other_coordinators() -> None:
    bench = ParticipantBench()
    bench.granted(1, 10 * MS)
    turns(bench.clock)
    bench.granted(2, 20 * MS, coordinator="ee")
    turns(bench.clock, times=2)
    assert bench.clock.step == 1


def test_a_participant_ends_when_its_coordinator_is_gone() -> None:
    bench = ParticipantBench()
    bench.granted(1, 10 * MS)
    turns(bench.clock, times=2)
    bench.wire.present = replace(bench.wire.present, seen={})
    with pytest.raises(LockStepError, match=r"simulator is gone, at 0\.01 s"):
        turns(bench.clock)


def test_the_last_step_ends_the_run() -> None:
    bench, ended = ParticipantBench(), list[int]()
    bench.clock.on_end = lambda: ended.append(bench.clock.now_ns)
    bench.granted(1, 10 * MS)
    turns(bench.clock, times=2)
    bench.granted(2, 10 * MS, is_last=True)
    turns(bench.clock, times=3)
    assert ended == []  # other processes may still wait for samples
    assert bench.wire.reports[-1].step == 2
    bench.wire.present = replace(bench.wire.present, seen={})
    turns(bench.clock, 20 * MS)
    assert ended == [10 * MS]


def test_samples_of_the_last_step_are_required_without_a_coordinator() -> None:
    bench, got, ended = ParticipantBench(), list[Any](), list[bool]()
    bench.clock.on_end = lambda: ended.append(True)
    gid, subscription = buffer_one(bench.clock, got)
    bench.granted(1, 10 * MS, sent={gid: Sent("/n", 1, 0, 0)})
    turns(bench.clock, times=2)
    sent = {gid: Sent("/n", 1, 1, 1)}
    bench.granted(2, 10 * MS, sent=sent, is_last=True)
    bench.wire.present = replace(bench.wire.present, seen={})
    turns(bench.clock, times=2)
    subscription.take(gid, ("message", 3 * MS, 0, 1))
    turns(bench.clock)
    assert (len(got), ended) == (1, [])
    turns(bench.clock)
    assert ended == [True]


def test_a_participant_logs_that_it_waits_for_a_simulator(
    caplog: pytest.LogCaptureFixture,
) -> None:
    bench = ParticipantBench()
    turns(bench.clock, times=8, timed_out=True)
    assert caplog.text == ""  # not during the first seconds
    bench.clock.log_after_s = 0.0
    turns(bench.clock, times=4, timed_out=True)
    assert caplog.text.count("/planner: waiting for a simulator with --lockst") == 1


def test_a_participant_off_the_network_is_an_error() -> None:
    with pytest.raises(LockStepError, match="not on the network"):
        turns(Participant())


# -- coordinator -----------------------------------------------------------------


class CoordinatorBench:
    """A coordinator of /planner and /control, and the reports it receives."""

    def __init__(self, **options: Any) -> None:
        self.clock = Coordinator(("planner", "/control"), **options)
        others = ("/planner", "/control")
        self.wire = FakeWire(SIM, Participants(("/sim",), others, 7, {ONE: 3, TWO: 4}))
        self.clock.join(self.wire)

    def receive(self, session: str, step: int, **more: Any) -> None:
        node, own = {ONE: ("/planner", 3), TWO: ("/control", 4)}[session]
        seen = {SIM: 7, ONE: 3, TWO: 4}
        del seen[session]
        report = StepReport(step, (node,), own, seen, {})
        self.wire.on_report(session, replace(report, **more))

    def begin(self) -> None:
        self.receive(ONE, 0)
        self.receive(TWO, 0)
        turns(self.clock, times=1)
        assert self.clock.step == 1


def test_the_run_begins_when_all_processes_know_all_endpoints() -> None:
    coordinated = CoordinatorBench()
    turns(coordinated.clock)
    coordinated.receive(ONE, 0)
    turns(coordinated.clock)
    coordinated.receive(TWO, 0, seen={SIM: 7, ONE: 2})
    turns(coordinated.clock)
    assert coordinated.wire.grants == []
    coordinated.receive(TWO, 0)
    turns(coordinated.clock)
    assert coordinated.wire.grants == [StepGrant(SIM, 1, 10 * MS, (ONE, TWO), {})]
    assert coordinated.clock.go_to(10 * MS, FakeWakeup())
    assert coordinated.clock.now_ns == 10 * MS


def test_the_coordinator_waits_for_every_report_of_a_step() -> None:
    coordinated = CoordinatorBench(step_s=0.001)
    coordinated.begin()
    coordinated.receive(ONE, 1)
    coordinated.receive(TWO, 0)  # late
    turns(coordinated.clock)
    assert len(coordinated.wire.grants) == 1
    gid = bytes(16)
    coordinated.receive(TWO, 1, sent={gid: Sent("/control", 1, 1, 1)})
    turns(coordinated.clock)
    assert coordinated.wire.grants[1].until_ns == 2 * MS
    assert coordinated.wire.grants[1].sent == {gid: Sent("/control", 1, 1, 1)}


def test_the_next_step_waits_until_new_endpoints_are_known() -> None:
    coordinated = CoordinatorBench()
    coordinated.begin()
    coordinated.receive(ONE, 1, own=4)
    coordinated.receive(TWO, 1)
    turns(coordinated.clock)
    assert len(coordinated.wire.grants) == 1
    coordinated.wire.present = replace(coordinated.wire.present, seen={ONE: 4, TWO: 4})
    coordinated.receive(TWO, 1, seen={SIM: 7, ONE: 4})
    turns(coordinated.clock)
    assert len(coordinated.wire.grants) == 2


def test_the_coordinator_logs_missing_nodes(caplog: pytest.LogCaptureFixture) -> None:
    coordinated = CoordinatorBench()
    coordinated.wire.present = replace(coordinated.wire.present, others=("/control",))
    coordinated.clock.log_after_s = 0.0
    # Also while reports are repeated all the time.
    turns(coordinated.clock, times=7)
    hint = "running without NAVETTE_LOCKSTEP=follow"
    assert f"waiting for /control ({hint}); /planner" in caplog.text
    assert len(caplog.records) == 1
    coordinated.receive(ONE, 0, nodes=("/plannr",))
    turns(coordinated.clock)
    assert "/planner; not named, but NAVETTE_LOCKSTEP=follow: /plannr" in caplog.text


def test_lost_reports_and_grants_are_repeated() -> None:
    coordinated, bench = CoordinatorBench(), ParticipantBench()
    coordinated.begin()
    turns(coordinated.clock, times=2, timed_out=True)
    assert coordinated.wire.grants == [coordinated.wire.grants[0]] * 3
    for grant in coordinated.wire.grants:
        bench.wire.on_grant(grant)
        turns(bench.clock, times=2)
    assert bench.clock.step == 1
    turns(bench.clock, times=2, timed_out=True)
    assert [report.step for report in bench.wire.reports] == [1, 1]


def test_two_processes_with_one_node_are_an_error() -> None:
    coordinated = CoordinatorBench()
    coordinated.receive(ONE, 0)
    coordinated.receive(TWO, 0, nodes=("/planner",))
    with pytest.raises(LockStepError, match="2 processes have /planner"):
        turns(coordinated.clock)


def test_a_node_that_is_gone_is_named() -> None:
    coordinated = CoordinatorBench()
    coordinated.begin()
    coordinated.wire.present = replace(coordinated.wire.present, seen={ONE: 3})
    with pytest.raises(LockStepError, match=r"gone at 0\.01 s: /control$"):
        turns(coordinated.clock)


def test_a_node_that_does_not_respond_is_named() -> None:
    coordinated = CoordinatorBench(limit_s=0.0)
    coordinated.begin()
    coordinated.receive(TWO, 1)
    with pytest.raises(LockStepError, match=r"no response within 0 s at 0\.01 s: /pl"):
        turns(coordinated.clock)


def test_a_node_without_all_endpoints_is_named() -> None:
    """Although all processes continue to report."""
    coordinated = CoordinatorBench(limit_s=0.02)
    coordinated.begin()

    def repeat_reports() -> None:
        for _ in range(1_000_000):
            coordinated.receive(ONE, 1, seen={SIM: 7, TWO: 5})
            coordinated.receive(TWO, 1)
            turns(coordinated.clock)

    with pytest.raises(LockStepError, match=r"s: /planner to see all of /control$"):
        repeat_reports()


def test_the_run_ends_at_its_time_for_all() -> None:
    coordinated, ended = CoordinatorBench(until_s=0.015), list[int]()
    coordinated.clock.on_end = lambda: ended.append(coordinated.clock.now_ns)
    coordinated.begin()
    for step in (1, 2):
        coordinated.receive(ONE, step)
        coordinated.receive(TWO, step)
        turns(coordinated.clock)
    assert [(g.until_ns, g.is_last) for g in coordinated.wire.grants] == [
        (10 * MS, False),
        (15 * MS, False),
        (15 * MS, True),
    ]
    coordinated.receive(ONE, 3)
    turns(coordinated.clock, 20 * MS)
    assert ended == []  # one participant may not have received it
    coordinated.wire.present = replace(coordinated.wire.present, seen={ONE: 3})
    turns(coordinated.clock, 20 * MS)
    assert ended == [15 * MS]


def test_the_real_time_factor_limits_the_steps() -> None:
    coordinated = CoordinatorBench(speed=1e-6)
    coordinated.begin()
    coordinated.receive(ONE, 1)
    coordinated.receive(TWO, 1)
    wakeup = FakeWakeup()
    wakeup.wait = lambda timeout_s: True  # type: ignore[method-assign]
    coordinated.clock.go_to(None, wakeup)
    assert len(coordinated.wire.grants) == 1


@pytest.mark.parametrize(
    ("nodes", "options"),
    [
        ((), {}),
        (("",), {}),
        (("a", "/a"), {}),
        (("a",), {"step_s": 0.0}),
        (("a",), {"step_s": math.nan}),
        (("a",), {"until_s": -1.0}),
        (("a",), {"speed": 0.0}),
    ],
)
def test_invalid_coordinators_are_refused(nodes: tuple[str, ...], options: Any) -> None:
    with pytest.raises(InvalidValueError):
        Coordinator(nodes, **options)


# -- the clock of a context ---------------------------------------------------


def test_the_environment_makes_a_participant(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NAVETTE_LOCKSTEP", "follow")
    assert isinstance(Context().clock, Participant)
    assert isinstance(Context(clock=VirtualClock()).clock, VirtualClock)
    monkeypatch.setenv("NAVETTE_LOCKSTEP", "lead")
    with pytest.raises(
        InvalidValueError, match="NAVETTE_LOCKSTEP 'lead': expected fol"
    ):
        Context()
    monkeypatch.setenv("NAVETTE_LOCKSTEP", "")
    assert isinstance(Context().clock, SystemClock)


def test_a_lock_step_needs_the_network(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NAVETTE_TRANSPORT", raising=False)
    assert chosen_transport(None, Participant()) == "zenoh"
    with pytest.raises(InvalidValueError, match="lock-step"):
        chosen_transport("inprocess", Participant())
    monkeypatch.setenv("NAVETTE_TRANSPORT", "inprocess")
    with pytest.raises(InvalidValueError, match="lock-step"):
        chosen_transport(None, Coordinator(("a",)))


def test_the_clock_of_a_lock_step_cannot_be_replaced(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    context = Context(clock=Participant())
    monkeypatch.setattr(context, "_join_network", lambda domain_id: None)
    context.init(args=[])
    with pytest.raises(InvalidValueError, match="lock-step"):
        Executor(context=context, clock=VirtualClock())
    context.shutdown()
