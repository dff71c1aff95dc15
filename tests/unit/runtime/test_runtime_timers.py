"""Timers and rates under virtual time, with rcl's timing."""

import threading
from typing import Any

import pytest

from navette.errors import CallbackError, InvalidValueError
from navette.runtime import ROSClock, ROSInterruptException
from navette.runtime.testing import GraphHarness
from navette.runtime.timer import TimerInfo

S = 1_000_000_000


def test_a_timer_runs_every_period(graph: GraphHarness) -> None:
    stamps: list[int] = []
    graph.node.create_timer(0.1, lambda: stamps.append(graph.now_ns))
    graph.run_for(0.35)
    assert stamps == [S // 10, 2 * S // 10, 3 * S // 10]


def test_timers_of_one_time_run_in_scheduling_order(
    graph: GraphHarness,
) -> None:
    order: list[str] = []
    graph.node.create_timer(0.2, lambda: order.append("slow"))
    graph.node.create_timer(0.1, lambda: order.append("fast"))
    graph.run_for(0.2)
    assert order == ["fast", "slow", "fast"]


def test_cancel_reset_and_state(graph: GraphHarness) -> None:
    hits: list[int] = []
    timer = graph.node.create_timer(1.0, lambda: hits.append(graph.now_ns))
    graph.run_for(0.25)
    assert timer.time_until_next_call() == 3 * S // 4
    assert timer.time_since_last_call() == S // 4
    assert not timer.is_ready()
    timer.cancel()
    assert timer.is_canceled()
    assert timer.time_until_next_call() is None
    graph.run_for(5.0)
    assert hits == []
    timer.reset()
    assert not timer.is_canceled()
    graph.run_for(1.0)
    assert hits == [round(6.25 * S)]


def test_cancel_from_its_own_callback(graph: GraphHarness) -> None:
    hits: list[int] = []

    def once() -> None:
        hits.append(graph.now_ns)
        timer.cancel()

    timer = graph.node.create_timer(0.5, once)
    graph.run_for(3.0)
    assert hits == [S // 2]


def test_a_cancel_by_another_thread_between_two_calls_holds(
    graph: GraphHarness, monkeypatch: pytest.MonkeyPatch
) -> None:
    hits: list[int] = []
    timer = graph.node.create_timer(0.5, lambda: hits.append(graph.now_ns))
    schedule = ROSClock.schedule

    def interrupted(clock: ROSClock, time_ns: int, entity: Any) -> None:
        if entity is timer:
            other = threading.Thread(target=timer.cancel)
            other.start()
            other.join()
        schedule(clock, time_ns, entity)

    monkeypatch.setattr(ROSClock, "schedule", interrupted)
    graph.run_for(3.0)
    assert hits == [S // 2]
    assert timer.is_canceled()


def test_reset_of_a_due_timer_restarts_the_period(graph: GraphHarness) -> None:
    hits: list[int] = []
    resets = graph.node.create_timer(1.0, lambda: (due.reset(), resets.cancel()))
    due = graph.node.create_timer(1.0, lambda: hits.append(graph.now_ns))
    graph.run_for(2.5)
    assert hits == [2 * S]


def test_late_timer_skips_and_keeps_its_phase(graph: GraphHarness) -> None:
    stamps: list[int] = []

    def tick() -> None:
        stamps.append(graph.now_ns)
        if len(stamps) == 1:
            graph.executor.spin_for(round(0.35 * S))  # holds its own group

    graph.node.create_timer(0.1, tick)
    graph.run_for(0.65)
    # Due at 0.2 but held until 0.45: one call then, the next in phase at 0.5.
    assert stamps == [S // 10, round(0.45 * S), S // 2, round(0.6 * S)]


def test_autostart_off_waits_for_reset(graph: GraphHarness) -> None:
    hits: list[int] = []
    timer = graph.node.create_timer(
        1.0, lambda: hits.append(graph.now_ns), autostart=False
    )
    graph.run_for(2.0)
    timer.reset()
    graph.run_for(1.0)
    assert hits == [3 * S]


def test_a_callback_may_take_the_timer_info(graph: GraphHarness) -> None:
    infos: list[TimerInfo] = []
    graph.node.create_timer(0.5, lambda info: infos.append(info))
    graph.run_for(0.5)
    assert infos[0].expected_call_time.nanoseconds == S // 2
    assert infos[0].actual_call_time.nanoseconds == S // 2


@pytest.mark.parametrize("period", [0.0, -1.0])
def test_period_must_be_positive(graph: GraphHarness, period: float) -> None:
    with pytest.raises(InvalidValueError, match="timer period"):
        graph.node.create_timer(period, lambda: None)


def test_a_destroyed_timer_does_not_run(graph: GraphHarness) -> None:
    timer = graph.node.create_timer(0.1, lambda: pytest.fail("was destroyed"))
    assert timer in list(graph.node.timers)
    assert graph.node.destroy_timer(timer)
    assert not graph.node.destroy_timer(timer)
    graph.run_for(1.0)


def test_raising_timer_names_node_timer_and_stamp(graph: GraphHarness) -> None:
    def bad() -> None:
        raise RuntimeError("bad tick")

    graph.node.create_timer(0.5, bad)
    with pytest.raises(CallbackError, match="bad tick") as caught:
        graph.run_for(1.0)
    assert caught.value.node == "/harness"
    assert caught.value.source == "timer of 0.5 s"
    assert caught.value.stamp_ns == S // 2


def test_events_run_while_a_rate_sleeps_in_plain_code(graph: GraphHarness) -> None:
    ticks: list[int] = []
    graph.node.create_timer(0.1, lambda: ticks.append(graph.now_ns))
    rate = graph.node.create_rate(2.0)
    stamps = []
    for _ in range(3):
        rate.sleep()
        stamps.append(graph.now_ns)
    assert stamps == [S // 2, S, 3 * S // 2]
    # The tick at 1.5 s runs after the end of the sleep, which was scheduled earlier.
    assert len(ticks) == 14


def test_rate_inside_a_callback_does_not_deadlock(graph: GraphHarness) -> None:
    log: list[tuple[str, int]] = []
    rate = graph.node.create_rate(10.0)

    def slow() -> None:
        timer.cancel()
        for _ in range(3):
            rate.sleep()
            log.append(("slept", graph.now_ns))

    timer = graph.node.create_timer(1.0, slow)
    graph.run_for(3.0)
    # The rate started at 0: the first sleep ends immediately, as in ROS.
    assert [stamp for _, stamp in log] == [S, round(1.1 * S), round(1.2 * S)]


def test_a_late_rate_skips_whole_periods(graph: GraphHarness) -> None:
    rate = graph.node.create_rate(1.0)
    graph.run_for(2.5)
    rate.sleep()
    assert graph.now_ns == round(2.5 * S)
    rate.sleep()
    assert graph.now_ns == 3 * S


def test_rate_after_shutdown_raises(graph: GraphHarness) -> None:
    rate = graph.node.create_rate(1.0)
    graph.context.shutdown()
    with pytest.raises(ROSInterruptException):
        rate.sleep()


def test_shutdown_ends_a_sleep(graph: GraphHarness) -> None:
    rate = graph.node.create_rate(0.001)
    graph.node.create_timer(1.0, graph.context.shutdown)
    with pytest.raises(ROSInterruptException):
        rate.sleep()


def test_an_invalid_rate_raises(graph: GraphHarness) -> None:
    with pytest.raises(InvalidValueError, match="rate must be > 0 Hz, got 0"):
        graph.node.create_rate(0)
