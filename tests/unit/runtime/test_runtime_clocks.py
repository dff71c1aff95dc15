"""Virtual, paced and system clocks, with a fake wall clock."""

import os
import signal
import threading
from collections.abc import Callable
from contextlib import suppress

import numpy as np
import pytest

from navette.errors import InvalidValueError
from navette.runtime import PacedClock, SystemClock, VirtualClock
from navette.runtime import clock as clock_module
from navette.runtime import wakeup as wakeup_module
from navette.runtime.clock import Stopwatch
from navette.runtime.events import Call
from navette.runtime.loop import EventLoop
from navette.runtime.wakeup import DescriptorWakeup, Wakeup, new_wakeup

LIMIT_S = 20.0  # reached by a defect only


class FakeWall:
    """Fake ``time`` module that only waits advance."""

    def __init__(self) -> None:
        self.now_s = 1000.0

    def perf_counter(self) -> float:
        return self.now_s

    def time_ns(self) -> int:
        return round(self.now_s * 1e9)


class FakeWakeup(Wakeup):
    """A wait takes its full time, or ends immediately if ``is_set``."""

    def __init__(self, wall: FakeWall) -> None:
        super().__init__()
        self.wall = wall
        self.is_set = False
        self.waits_s: list[float | None] = []

    def wait(self, timeout_s: float | None) -> bool:
        self.waits_s.append(timeout_s)
        if not self.is_set:
            assert timeout_s is not None, "would wait for ever"
            self.wall.now_s += timeout_s
        return self.is_set


@pytest.fixture
def wall(monkeypatch: pytest.MonkeyPatch) -> FakeWall:
    fake = FakeWall()
    monkeypatch.setattr(clock_module, "time", fake)
    monkeypatch.setattr(wakeup_module, "time", fake)
    return fake


def test_virtual_clock_jumps_to_the_target(wall: FakeWall) -> None:
    clock, wakeup = VirtualClock(5), FakeWakeup(wall)
    assert clock.go_to(10**12, wakeup)
    assert clock.now_ns == 10**12
    assert wakeup.waits_s == []


def test_virtual_clock_is_monotonic(wall: FakeWall) -> None:
    clock = VirtualClock(10)
    clock.go_to(5, FakeWakeup(wall))
    assert clock.now_ns == 10


def test_paced_clock_waits_at_its_factor(wall: FakeWall) -> None:
    clock, wakeup = PacedClock(2.0), FakeWakeup(wall)
    for second in range(1, 5):
        assert clock.go_to(second * 10**9, wakeup)
    assert wakeup.waits_s == pytest.approx([0.5] * 4)
    assert clock.real_time_factor == pytest.approx(2.0)
    assert clock.lag_s == 0.0


def test_paced_clock_catches_up_after_a_short_delay(wall: FakeWall) -> None:
    clock, wakeup = PacedClock(1.0), FakeWakeup(wall)
    clock.go_to(10**9, wakeup)
    wall.now_s += 0.1
    clock.go_to(2 * 10**9, wakeup)
    assert wakeup.waits_s == pytest.approx([1.0, 0.9])


def test_paced_clock_does_not_catch_up_after_a_long_delay(wall: FakeWall) -> None:
    clock, wakeup = PacedClock(1.0), FakeWakeup(wall)
    clock.go_to(10**9, wakeup)
    wall.now_s += 10.0
    clock.go_to(2 * 10**9, wakeup)
    assert clock.lag_s == pytest.approx(9.0)
    clock.go_to(3 * 10**9, wakeup)
    assert wakeup.waits_s[-1] == pytest.approx(1.0)


def test_paced_clock_does_not_advance_when_woken(wall: FakeWall) -> None:
    clock, wakeup = PacedClock(1.0), FakeWakeup(wall)
    wakeup.is_set = True
    assert not clock.go_to(10**9, wakeup)
    assert clock.now_ns == 0


def test_paused_clock_does_not_advance(wall: FakeWall) -> None:
    clock, wakeup = PacedClock(1.0), FakeWakeup(wall)
    clock.paused = True
    wakeup.is_set = True
    assert not clock.go_to(10**9, wakeup)
    assert wakeup.waits_s == [None]
    clock.paused = False
    wall.now_s += 100.0
    wakeup.is_set = False
    clock.factor = 4.0
    clock.go_to(10**9, wakeup)
    assert wakeup.waits_s[-1] == pytest.approx(0.25)


@pytest.mark.parametrize("make", [VirtualClock, lambda: PacedClock(1.0)])
def test_a_paused_clock_advances_by_steps_without_waiting(
    wall: FakeWall, make: Callable[[], VirtualClock]
) -> None:
    clock, wakeup = make(), FakeWakeup(wall)
    clock.step(10)
    clock.paused = True
    clock.step(100)
    clock.paused = True  # keeps the step
    assert clock.go_to(60, wakeup)
    wakeup.is_set = True
    assert not clock.go_to(101, wakeup)
    assert (clock.now_ns, wakeup.waits_s) == (100, [None])
    clock.paused = False
    assert not clock.paused


def test_system_clock_waits(wall: FakeWall) -> None:
    clock, wakeup = SystemClock(), FakeWakeup(wall)
    start = clock.now_ns
    assert clock.go_to(start + 2 * 10**9, wakeup)
    assert clock.now_ns == pytest.approx(start + 2 * 10**9)
    assert clock.go_to(start, wakeup)
    assert len(wakeup.waits_s) == 1


@pytest.mark.parametrize("factor", [0.0, -1.0, float("inf"), float("nan")])
def test_invalid_factor_raises(factor: float) -> None:
    with pytest.raises(InvalidValueError, match="real-time factor"):
        PacedClock(factor)


def test_negative_start_raises() -> None:
    with pytest.raises(InvalidValueError, match="start"):
        VirtualClock(-1)


KINDS = [Wakeup, *([DescriptorWakeup] if hasattr(os, "eventfd") else [])]


@pytest.mark.parametrize("kind", KINDS)
def test_wakeup_ends_a_wait(kind: type[Wakeup]) -> None:
    wakeup = kind()
    wakeup.set()
    assert wakeup.wait(None)
    wakeup.clear()
    assert not wakeup.wait(0.0)


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="POSIX timers")
@pytest.mark.parametrize("kind", KINDS)
def test_ctrl_c_in_any_line_of_a_wait_leaves_it_usable(kind: type[Wakeup]) -> None:
    """With threading.Event, one in a few thousand interrupts locked it for ever."""
    wakeup = kind()
    rng = np.random.default_rng(0)
    before = signal.signal(signal.SIGALRM, signal.default_int_handler)
    try:
        for delay_s in rng.uniform(1e-6, 60e-6, 3000):
            with suppress(KeyboardInterrupt):
                signal.setitimer(signal.ITIMER_REAL, delay_s)
                while True:
                    try:
                        wakeup.wait(1e-6)
                    finally:
                        wakeup.clear()
    finally:
        signal.signal(signal.SIGALRM, before)
    assert not wakeup.wait(0.0)
    wakeup.set()
    wakeup.set()
    assert wakeup.is_pending
    assert wakeup.wait(None)
    wakeup.clear()
    assert not wakeup.is_pending


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("timeout_s", [0.0, 300e-6, 2.3e-3])
def test_a_wait_ends_at_its_timeout(kind: type[Wakeup], timeout_s: float) -> None:
    watch = Stopwatch()
    assert not kind().wait(timeout_s)
    assert watch.elapsed_s >= timeout_s


@pytest.mark.parametrize("kind", KINDS)
def test_a_set_by_another_thread_is_never_missed(kind: type[Wakeup]) -> None:
    here, there = kind(), kind()

    def answer() -> None:
        for _ in range(2000):
            assert there.wait(LIMIT_S)
            there.clear()
            here.set()

    thread = threading.Thread(target=answer)
    thread.start()
    for _ in range(2000):
        there.set()
        assert here.wait(LIMIT_S)
        here.clear()
    thread.join()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="POSIX")
def test_a_forked_process_has_its_own_wakeup() -> None:
    wakeup = new_wakeup()
    child = os.fork()
    if not child:
        wakeup.set()
        os._exit(not wakeup.is_pending)
    assert os.waitpid(child, 0)[1] == 0
    assert not wakeup.wait(0.0)


def test_an_entity_has_its_token_before_the_loop_is_woken() -> None:
    """Otherwise the loop takes the event for a cancelled one and drops it."""
    tokens: list[int] = []

    class Recorder(Wakeup):
        def set(self) -> None:
            tokens.append(call.token)

    loop = EventLoop(VirtualClock())
    loop._wakeup = Recorder()
    loop.waiting = True
    call = Call(lambda: None, loop.free_group, "test", "")
    loop.schedule(5, call)
    assert tokens == [call.token]
    assert call.token != 0
