"""Callback groups with a program's own rules."""

from typing import Any

import pytest

from navette.runtime import Executor, Future, Node, VirtualClock
from navette.runtime.callback_groups import CallbackGroup


class Bucket(CallbackGroup):
    """Token bucket: each callback takes a token."""

    def __init__(self) -> None:
        super().__init__()
        self.tokens = 2
        self.calls: list[str] = []
        self.rejects = False

    def can_execute(self, entity: Any) -> bool:
        return self.tokens > 0

    def beginning_execution(self, entity: Any) -> bool:
        if self.rejects:
            return False
        self.tokens -= 1
        self.calls.append("begins")
        return True

    def ending_execution(self, entity: Any) -> None:
        self.calls.append("ends")


def bucket_node() -> tuple[Executor, Node, Bucket, list[float]]:
    executor = Executor(clock=VirtualClock())
    node = Node("n", context=executor.context)
    executor.add_node(node)
    bucket = Bucket()
    times: list[float] = []
    node.create_timer(
        0.1, lambda: times.append(executor.now_ns / 1e9), callback_group=bucket
    )
    return executor, node, bucket, times


def test_a_custom_group() -> None:
    executor, node, bucket, times = bucket_node()

    def refill() -> None:
        bucket.tokens += 1

    node.create_timer(1.05, refill)
    executor.spin_for(2_200_000_000)
    assert times == pytest.approx([0.1, 0.2, 1.05, 2.1])
    assert bucket.calls == ["begins", "ends"] * 4
    assert not bucket.can_execute(None)


def test_a_rejection_right_before_the_callback_does_not_stop_the_loop() -> None:
    executor, node, bucket, times = bucket_node()
    bucket.rejects = True
    ticks: list[int] = []
    node.create_timer(0.5, lambda: ticks.append(1))
    executor.spin_for(1_000_000_000)
    assert (times, len(ticks)) == ([], 2)
    executor.remove_node(node)
    bucket.rejects = False
    executor.spin_for(1_000_000_000)
    assert times == []
    executor.add_node(node)
    executor.spin_once(timeout_sec=0.0)
    assert len(times) == 1


def test_the_group_is_notified_of_the_end_of_a_coroutine() -> None:
    executor, node, bucket, _ = bucket_node()
    future: Future[None] = Future(executor=executor)

    async def waits() -> None:
        await future

    bucket.tokens = 1
    guard = node.create_guard_condition(waits, callback_group=bucket)
    guard.trigger()
    executor.spin_for(50_000_000)
    assert bucket.calls == ["begins"]
    future.set_result(None)
    executor.spin_for(10_000_000)
    assert bucket.calls == ["begins", "ends"]
