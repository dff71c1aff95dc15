"""Rates with bursts, in the queue of commands and in the selector."""

import itertools
from collections.abc import Callable
from functools import partial

import pytest
from viewer_fakes import FakeBridge, FakeClock

from navette.viewer.command_queue import CommandQueue
from navette.viewer.throttled_selector import ThrottledSelector
from navette.viewer.token_bucket import TokenBucket


@pytest.fixture
def time() -> FakeClock:
    return FakeClock()


def test_a_bucket_permits_a_burst_and_then_its_rate(time: FakeClock) -> None:
    bucket = TokenBucket(2.0, 5.0, time)
    assert [bucket.try_take(1) for _ in range(6)] == [True] * 5 + [False]
    time.wait(1.0)
    assert [bucket.try_take(1) for _ in range(3)] == [True, True, False]
    time.wait(100.0)
    assert bucket.is_full
    assert sum(bucket.try_take(1) for _ in range(10)) == 5


def test_a_debt_is_paid_off_at_the_rate(time: FakeClock) -> None:
    bucket = TokenBucket(2.0, 5.0, time)
    bucket.take(9.0)
    assert bucket.wait_s() == 2.0
    time.wait(1.5)
    assert bucket.wait_s() == 0.5
    time.wait(1.0)
    assert bucket.wait_s() == 0.0


def test_a_thread_that_works_more_than_its_share_sleeps(time: FakeClock) -> None:
    """In any mix of work its sum stays below burst + share * time."""

    def work(selector: ThrottledSelector, seconds: float) -> None:
        time.work(seconds)
        selector.select(0.0)

    with ThrottledSelector(0.25, 0.1, time) as selector:
        for work_s in (0.05, 0.02, 1.0, 0.001, 0.3) * 20:
            work(selector, work_s)
            assert time.thread_cpu_s <= 0.1 + 0.25 * time.now_s + 1e-9
        assert time.slept_s > 0
    with ThrottledSelector(0.25, 0.1, time) as selector:
        before_s = time.slept_s
        work(selector, 0.09)
        assert time.slept_s == before_s


def test_a_thread_that_waits_for_a_core_or_the_interpreter_does_not_sleep(
    time: FakeClock,
) -> None:
    """The operator's command behind it must not wait even longer."""
    with ThrottledSelector(0.2, 0.05, time) as selector:
        for _ in range(100):
            time.wait(0.299)
            time.work(0.001)
            selector.select(0.0)
    assert time.slept_s == 0.0


class Executor:
    """Runs scheduled functions one by one, and keeps delayed ones."""

    def __init__(self, time: FakeClock) -> None:
        bridge = FakeBridge()
        self.ready, self.later = bridge.soon, bridge.later
        self.queue = CommandQueue(bridge=bridge, clock=time)

    def turn(self) -> None:
        self.ready.pop(0)()

    def rest(self, time: FakeClock) -> float:
        """Let the time pass until the next slice may begin; return how long."""
        [(delay_s, function)] = self.later
        self.later.clear()
        time.wait(delay_s)
        function()
        return delay_s


def test_commands_of_a_flooding_client_do_not_delay_those_of_others(
    time: FakeClock,
) -> None:
    executor, ran = Executor(time), list[str]()

    def command(name: str) -> Callable[[], None]:
        def run() -> None:
            time.work(0.0015)
            ran.append(name)

        return run

    for number in range(100):
        executor.queue.add("flood", command(f"flood {number}"))
    executor.queue.add("driver", command("stop"))
    assert len(executor.ready) == 1
    executor.turn()
    assert ran == ["flood 0", "stop"]
    assert executor.ready == [], "calls that wait run before the events that are due"
    assert executor.rest(time) == pytest.approx(0.003)
    assert len(executor.ready) == 1


def test_no_two_slices_follow_each_other_directly(time: FakeClock) -> None:
    """Whatever arrives: the loop's other events have at least half of the time."""
    executor, slices = Executor(time), list[tuple[float, float]]()

    def command() -> None:
        begin_s = time.now_s
        time.work(0.004)
        slices.append((begin_s, time.now_s))

    for number in range(20):  # each alone in the queue: it empties every time
        executor.queue.add(number, command)
        if executor.later:
            assert executor.ready == []
            executor.rest(time)
        executor.turn()
    assert len(slices) == 20
    for (begin_s, end_s), (next_s, _) in itertools.pairwise(slices):
        assert next_s - end_s >= end_s - begin_s - 1e-9


def test_a_command_after_a_pause_does_not_wait(time: FakeClock) -> None:
    executor = Executor(time)
    for _ in range(100):  # an operator's stick
        executor.queue.add("driver", partial(time.work, 0.001))
        assert executor.later == []
        executor.turn()
        time.wait(0.05)


def test_commands_use_a_tenth_of_the_executor_at_most(time: FakeClock) -> None:
    executor, used_s = Executor(time), list[float]()

    def command() -> None:
        time.work(0.01)
        used_s.append(0.01)

    for number in range(500):
        executor.queue.add(number % 7, command)
    while executor.ready or executor.later:
        if executor.ready:
            executor.turn()
            assert sum(used_s) <= 0.25 + 0.01 + 0.1 * time.now_s + 1e-9
        else:
            (delay_s, function) = executor.later.pop()
            time.wait(delay_s)
            function()
    assert sum(used_s) == pytest.approx(5.0)


def test_commands_are_not_charged_for_what_other_threads_do(time: FakeClock) -> None:
    executor, ran = Executor(time), list[int]()

    def command(number: int) -> Callable[[], None]:
        def run() -> None:
            time.wait(0.2)
            time.work(0.0001)
            ran.append(number)

        return run

    for number in range(50):
        executor.queue.add("driver", command(number))
    rests_s = []
    executor.turn()
    while executor.later:
        rests_s.append(executor.rest(time))
        executor.turn()
    assert ran == list(range(50))
    assert max(rests_s) == pytest.approx(0.02), "the longest rest, without a debt"


def test_commands_of_a_lane_run_in_order_and_replace_their_like(
    time: FakeClock,
) -> None:
    executor, ran = Executor(time), list[str]()
    for name, key in (
        ("watch a", "a"),
        ("watch b", "b"),
        ("unwatch a", "a"),
        ("watch a", "a"),
        ("open", None),
        ("publish", None),
    ):
        executor.queue.add(1, lambda name=name: ran.append(name), key)  # type: ignore[misc]
    executor.turn()
    assert ran == ["watch b", "watch a", "open", "publish"]
    assert executor.ready == []
    executor.queue.add(1, lambda: ran.append("next"))
    executor.turn()
    assert ran[-1] == "next"


def test_commands_that_end_work_run_first_and_replace_their_beginning(
    time: FakeClock,
) -> None:
    executor, ran = Executor(time), list[str]()
    for name in ("a", "b", "c"):
        executor.queue.add(0, partial(ran.append, f"begin {name}"), name)
    executor.queue.add(0, partial(ran.append, "end c"), "c", is_next=True)
    executor.queue.add(0, partial(ran.append, "end b"), "b", is_next=True)
    executor.queue.add(0, partial(ran.append, "begin b again"), "b")
    executor.turn()
    assert ran == ["end c", "begin a", "begin b again"]
    assert not executor.ready
