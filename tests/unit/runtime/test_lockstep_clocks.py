"""The two clocks of a lock-step on a wire that the test holds in its hands."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from navette.errors import InvalidValueError, LockStepError
from navette.runtime import Context, Executor, SystemClock, VirtualClock
from navette.runtime.clock import Wakeup
from navette.runtime.lockstep import Conductor, Follower, LockStepClock
from navette.runtime.network import chosen_transport
from navette.transports import Endpoint, EndpointKind, EndpointQos
from navette.transports.lockstep import Census, Grant, Report, Sent, StepWire

SIM, ONE, TWO = "51", "01", "02"
MS = 10**6


class FakeWire(StepWire):
    """Notes what is told; what is heard is what the test says."""

    def __init__(self, session: str, census: Census) -> None:
        self._session = session
        self.there = census
        self.reports: list[Report] = []
        self.grants: list[Grant] = []
        self.on_report: Callable[[str, Report], None]
        self.on_grant: Callable[[Grant], None]

    @property
    def session(self) -> str:
        return self._session

    def census(self) -> Census:
        return self.there

    def report(self, report: Report) -> None:
        self.reports.append(report)

    def grant(self, grant: Grant) -> None:
        self.grants.append(grant)

    def hear_reports(self, callback: Callable[[str, Report], None]) -> None:
        self.on_report = callback

    def hear_grants(self, callback: Callable[[Grant], None]) -> None:
        self.on_grant = callback


class FakeWakeup(Wakeup):
    """A wait ends at once: by something, or (``in_vain``) by its end."""

    def __init__(self, *, in_vain: bool = False) -> None:
        super().__init__()
        self._in_vain = in_vain

    def wait(self, timeout_s: float | None) -> bool:
        return self.is_pending or not (self._in_vain or timeout_s == 0.0)


def turns(
    clock: LockStepClock,
    target_ns: int | None = None,
    times: int = 1,
    *,
    in_vain: bool = False,
) -> None:
    """What a loop does that has nothing to run before ``target_ns``."""
    for _ in range(times):
        clock.go_to(target_ns, FakeWakeup(in_vain=in_vain))


# -- follower ------------------------------------------------------------------


class Followed:
    """A follower with node /planner and what it tells the conductor."""

    def __init__(self, limit_s: float = 30.0) -> None:
        self.clock = Follower(limit_s)
        self.wire = FakeWire(ONE, Census(("/planner",), ("/sim",), 5, {SIM: 7}))
        self.clock.join(self.wire)

    def granted(self, step: int, until_ns: int, **more: Any) -> None:
        sent = more.pop("sent", {})
        grant = Grant(SIM, step, until_ns, (ONE, TWO), sent)
        self.wire.on_grant(replace(grant, **more))


def test_a_follower_stands_at_zero_and_says_who_is_there() -> None:
    followed = Followed()
    turns(followed.clock, 3 * MS, times=3)
    assert followed.clock.now_ns == 0
    assert followed.wire.reports == [Report(0, ("/planner",), 5, {SIM: 7}, {})]


def test_a_follower_tells_of_endpoints_that_came() -> None:
    followed = Followed()
    turns(followed.clock)
    followed.wire.there = replace(followed.wire.there, seen={SIM: 8})
    turns(followed.clock)
    assert [report.seen for report in followed.wire.reports] == [{SIM: 7}, {SIM: 8}]


def test_a_follower_runs_what_was_granted_and_no_more() -> None:
    followed = Followed()
    followed.granted(1, 10 * MS)
    turns(followed.clock, 4 * MS)
    assert followed.clock.now_ns == 0  # the grant is taken in
    wakeup = FakeWakeup()
    assert followed.clock.go_to(4 * MS, wakeup)
    assert followed.clock.now_ns == 4 * MS
    assert followed.clock.go_to(10 * MS, wakeup)
    assert not followed.clock.go_to(11 * MS, wakeup)
    assert followed.clock.now_ns == 10 * MS
    assert followed.wire.reports[-1].step == 1


def test_a_follower_reports_what_it_sent_once_a_step() -> None:
    followed = Followed()
    sent = followed.clock.traffic.tally.open(bytes(16), "/planner")
    sent(1)
    turns(followed.clock)
    assert followed.wire.reports[-1].sent == {bytes(16): Sent("/planner", 1, 1, 1)}
    followed.granted(1, 10 * MS, sent=followed.wire.reports[-1].sent)
    turns(followed.clock, times=3)
    assert [(report.step, dict(report.sent)) for report in followed.wire.reports] == [
        (0, {bytes(16): Sent("/planner", 1, 1, 1)}),
        (1, {}),
    ]


def hold_one(clock: LockStepClock, got: list[Any]) -> tuple[bytes, Any]:
    """A subscription with one remote publisher, since before the beginning."""
    gid = bytes(15) + b"g"
    endpoint = Endpoint(
        EndpointKind.PUBLISHER, "/t", "p/msg/T", EndpointQos(), "n", "/", gid, "h"
    )
    holding = clock.traffic.held.open(
        "/t", got.append, lambda: {gid: endpoint}, is_latched=False, depth=1
    )
    return gid, holding


def test_a_step_begins_when_its_samples_are_here() -> None:
    followed, got = Followed(), list[Any]()
    gid, holding = hold_one(followed.clock, got)
    followed.granted(1, 10 * MS, sent={gid: Sent("/n", 1, 0, 0)})
    turns(followed.clock, times=2)
    followed.granted(2, 20 * MS, sent={gid: Sent("/n", 1, 1, 1)})
    turns(followed.clock)
    assert followed.clock.step == 1
    holding.take(gid, ("message", 3 * MS, 0, 1))
    assert got == []
    turns(followed.clock)
    assert followed.clock.step == 2
    assert got == [("message", 3 * MS, 10 * MS, 1)]
    assert followed.clock.now_ns == 10 * MS


def test_samples_that_do_not_come_are_named() -> None:
    followed = Followed(limit_s=0.0)
    gid, _ = hold_one(followed.clock, [])
    followed.granted(1, 10 * MS, sent={gid: Sent("/n", 1, 0, 0)})
    turns(followed.clock, times=2)
    followed.granted(2, 20 * MS, sent={gid: Sent("/n", 1, 3, 3)})
    turns(followed.clock)
    with pytest.raises(LockStepError, match=r"0\.01 s: 3 of /t by /n"):
        turns(followed.clock)


def test_a_follower_that_nobody_named_says_so() -> None:
    followed = Followed()
    followed.granted(1, 10 * MS, roster=(TWO,))
    with pytest.raises(LockStepError, match="does not wait for /planner"):
        turns(followed.clock)


def test_a_follower_does_not_leave_steps_out() -> None:
    followed = Followed()
    followed.granted(2, 10 * MS)
    with pytest.raises(LockStepError, match="after step 0 came step 2"):
        turns(followed.clock)


def test_a_follower_of_one_conductor_does_not_hear_another() -> None:
    followed = Followed()
    followed.granted(1, 10 * MS)
    turns(followed.clock)
    followed.granted(2, 20 * MS, conductor="ee")
    turns(followed.clock, times=2)
    assert followed.clock.step == 1


def test_a_follower_ends_when_its_conductor_is_gone() -> None:
    followed = Followed()
    followed.granted(1, 10 * MS)
    turns(followed.clock, times=2)
    followed.wire.there = replace(followed.wire.there, seen={})
    with pytest.raises(LockStepError, match=r"simulator is gone, at 0\.01 s"):
        turns(followed.clock)


def test_the_last_step_ends_the_run() -> None:
    followed, ended = Followed(), list[int]()
    followed.clock.on_end = lambda: ended.append(followed.clock.now_ns)
    followed.granted(1, 10 * MS)
    turns(followed.clock, times=2)
    followed.granted(2, 10 * MS, is_last=True)
    turns(followed.clock, times=3)
    assert ended == []  # others may not have all that was sent to them
    assert followed.wire.reports[-1].step == 2
    followed.wire.there = replace(followed.wire.there, seen={})
    turns(followed.clock, 20 * MS)
    assert ended == [10 * MS]


def test_samples_of_the_last_step_are_waited_for_without_a_conductor() -> None:
    followed, got, ended = Followed(), list[Any](), list[bool]()
    followed.clock.on_end = lambda: ended.append(True)
    gid, holding = hold_one(followed.clock, got)
    followed.granted(1, 10 * MS, sent={gid: Sent("/n", 1, 0, 0)})
    turns(followed.clock, times=2)
    sent = {gid: Sent("/n", 1, 1, 1)}
    followed.granted(2, 10 * MS, sent=sent, is_last=True)
    followed.wire.there = replace(followed.wire.there, seen={})
    turns(followed.clock, times=2)
    holding.take(gid, ("message", 3 * MS, 0, 1))
    turns(followed.clock)
    assert (len(got), ended) == (1, [])
    turns(followed.clock)
    assert ended == [True]


def test_a_follower_that_waits_for_a_simulator_says_so(
    caplog: pytest.LogCaptureFixture,
) -> None:
    followed = Followed()
    turns(followed.clock, times=8, in_vain=True)
    assert caplog.text == ""  # not before some seconds
    followed.clock.say_after_s = 0.0
    turns(followed.clock, times=4, in_vain=True)
    assert caplog.text.count("/planner: waiting for a simulator with --lockst") == 1


def test_a_follower_off_the_network_is_an_error() -> None:
    with pytest.raises(LockStepError, match="not on the network"):
        turns(Follower())


# -- conductor -----------------------------------------------------------------


class Conducted:
    """A conductor of /planner and /control, and what it is told."""

    def __init__(self, **options: Any) -> None:
        self.clock = Conductor(("planner", "/control"), **options)
        others = ("/planner", "/control")
        self.wire = FakeWire(SIM, Census(("/sim",), others, 7, {ONE: 3, TWO: 4}))
        self.clock.join(self.wire)

    def told(self, session: str, step: int, **more: Any) -> None:
        node, own = {ONE: ("/planner", 3), TWO: ("/control", 4)}[session]
        seen = {SIM: 7, ONE: 3, TWO: 4}
        del seen[session]
        report = Report(step, (node,), own, seen, {})
        self.wire.on_report(session, replace(report, **more))

    def begin(self) -> None:
        self.told(ONE, 0)
        self.told(TWO, 0)
        turns(self.clock, times=1)
        assert self.clock.step == 1


def test_the_conductor_begins_when_all_know_each_other() -> None:
    conducted = Conducted()
    turns(conducted.clock)
    conducted.told(ONE, 0)
    turns(conducted.clock)
    conducted.told(TWO, 0, seen={SIM: 7, ONE: 2})
    turns(conducted.clock)
    assert conducted.wire.grants == []
    conducted.told(TWO, 0)
    turns(conducted.clock)
    assert conducted.wire.grants == [Grant(SIM, 1, 10 * MS, (ONE, TWO), {})]
    assert conducted.clock.go_to(10 * MS, FakeWakeup())
    assert conducted.clock.now_ns == 10 * MS


def test_the_conductor_waits_for_every_report_of_a_step() -> None:
    conducted = Conducted(step_s=0.001)
    conducted.begin()
    conducted.told(ONE, 1)
    conducted.told(TWO, 0)  # late
    turns(conducted.clock)
    assert len(conducted.wire.grants) == 1
    gid = bytes(16)
    conducted.told(TWO, 1, sent={gid: Sent("/control", 1, 1, 1)})
    turns(conducted.clock)
    assert conducted.wire.grants[1].until_ns == 2 * MS
    assert conducted.wire.grants[1].sent == {gid: Sent("/control", 1, 1, 1)}


def test_endpoints_that_come_later_are_waited_for() -> None:
    conducted = Conducted()
    conducted.begin()
    conducted.told(ONE, 1, own=4)
    conducted.told(TWO, 1)
    turns(conducted.clock)
    assert len(conducted.wire.grants) == 1
    conducted.wire.there = replace(conducted.wire.there, seen={ONE: 4, TWO: 4})
    conducted.told(TWO, 1, seen={SIM: 7, ONE: 4})
    turns(conducted.clock)
    assert len(conducted.wire.grants) == 2


def test_the_conductor_says_who_is_missing(caplog: pytest.LogCaptureFixture) -> None:
    conducted = Conducted()
    conducted.wire.there = replace(conducted.wire.there, others=("/control",))
    conducted.clock.say_after_s = 0.0
    # Also while something comes all the time, such as reports that are said again.
    turns(conducted.clock, times=7)
    hint = "there, but not with NAVETTE_LOCKSTEP=follow"
    assert f"waiting for /control ({hint}); /planner" in caplog.text
    assert len(caplog.records) == 1
    conducted.told(ONE, 0, nodes=("/plannr",))
    turns(conducted.clock)
    assert "/planner; following, but not named: /plannr" in caplog.text


def test_what_got_lost_is_said_again() -> None:
    conducted, followed = Conducted(), Followed()
    conducted.begin()
    turns(conducted.clock, times=2, in_vain=True)
    assert conducted.wire.grants == [conducted.wire.grants[0]] * 3
    for grant in conducted.wire.grants:
        followed.wire.on_grant(grant)
        turns(followed.clock, times=2)
    assert followed.clock.step == 1
    turns(followed.clock, times=2, in_vain=True)
    assert [report.step for report in followed.wire.reports] == [1, 1]


def test_two_processes_with_one_node_are_an_error() -> None:
    conducted = Conducted()
    conducted.told(ONE, 0)
    conducted.told(TWO, 0, nodes=("/planner",))
    with pytest.raises(LockStepError, match="2 processes have /planner"):
        turns(conducted.clock)


def test_who_is_gone_is_named() -> None:
    conducted = Conducted()
    conducted.begin()
    conducted.wire.there = replace(conducted.wire.there, seen={ONE: 3})
    with pytest.raises(LockStepError, match=r"gone at 0\.01 s: /control$"):
        turns(conducted.clock)


def test_who_does_not_answer_is_named() -> None:
    conducted = Conducted(limit_s=0.0)
    conducted.begin()
    conducted.told(TWO, 1)
    with pytest.raises(LockStepError, match=r"no answer within 0 s at 0\.01 s: /pl"):
        turns(conducted.clock)


def test_who_never_sees_all_of_the_others_is_named() -> None:
    """Though all go on saying what they see."""
    conducted = Conducted(limit_s=0.02)
    conducted.begin()

    def go_on() -> None:
        for _ in range(1_000_000):
            conducted.told(ONE, 1, seen={SIM: 7, TWO: 5})
            conducted.told(TWO, 1)
            turns(conducted.clock)

    with pytest.raises(LockStepError, match=r"s: /planner to see all of /control$"):
        go_on()


def test_the_run_ends_at_its_time_for_all() -> None:
    conducted, ended = Conducted(until_s=0.015), list[int]()
    conducted.clock.on_end = lambda: ended.append(conducted.clock.now_ns)
    conducted.begin()
    for step in (1, 2):
        conducted.told(ONE, step)
        conducted.told(TWO, step)
        turns(conducted.clock)
    assert [(g.until_ns, g.is_last) for g in conducted.wire.grants] == [
        (10 * MS, False),
        (15 * MS, False),
        (15 * MS, True),
    ]
    conducted.told(ONE, 3)
    turns(conducted.clock, 20 * MS)
    assert ended == []  # one may not have heard of it
    conducted.wire.there = replace(conducted.wire.there, seen={ONE: 3})
    turns(conducted.clock, 20 * MS)
    assert ended == [15 * MS]


def test_a_pace_holds_the_steps_back() -> None:
    conducted = Conducted(speed=1e-6)
    conducted.begin()
    conducted.told(ONE, 1)
    conducted.told(TWO, 1)
    wakeup = FakeWakeup()
    wakeup.wait = lambda timeout_s: True  # type: ignore[method-assign]
    conducted.clock.go_to(None, wakeup)
    assert len(conducted.wire.grants) == 1


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
def test_a_conductor_that_cannot_be(nodes: tuple[str, ...], options: Any) -> None:
    with pytest.raises(InvalidValueError):
        Conductor(nodes, **options)


# -- who follows ---------------------------------------------------------------


def test_the_environment_makes_a_follower(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NAVETTE_LOCKSTEP", "follow")
    assert isinstance(Context().clock, Follower)
    assert isinstance(Context(clock=VirtualClock()).clock, VirtualClock)
    monkeypatch.setenv("NAVETTE_LOCKSTEP", "lead")
    with pytest.raises(InvalidValueError, match="NAVETTE_LOCKSTEP 'lead'; known: fol"):
        Context()
    monkeypatch.setenv("NAVETTE_LOCKSTEP", "")
    assert isinstance(Context().clock, SystemClock)


def test_a_lock_step_needs_the_network(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NAVETTE_TRANSPORT", raising=False)
    assert chosen_transport(None, Follower()) == "zenoh"
    with pytest.raises(InvalidValueError, match="lock-step"):
        chosen_transport("inprocess", Follower())
    monkeypatch.setenv("NAVETTE_TRANSPORT", "inprocess")
    with pytest.raises(InvalidValueError, match="lock-step"):
        chosen_transport(None, Conductor(("a",)))


def test_the_clock_of_a_lock_step_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    context = Context(clock=Follower())
    monkeypatch.setattr(context, "_join_network", lambda: None)
    context.init(args=[])
    with pytest.raises(InvalidValueError, match="lock-step"):
        Executor(context=context, clock=VirtualClock())
    context.shutdown()
