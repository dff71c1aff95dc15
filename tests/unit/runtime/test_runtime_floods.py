"""More messages than callbacks can take: timers and other callbacks still run."""

import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from navette.msgs.std_msgs.msg import Int32
from navette.runtime import (
    Context,
    Executor,
    MultiThreadedExecutor,
    Node,
    SingleThreadedExecutor,
    VirtualClock,
)

MS = 1_000_000
DEPTH = 5


class StepClock(VirtualClock):
    """A system clock that only callbacks advance."""

    is_virtual = False


@pytest.fixture
def clock() -> StepClock:
    return StepClock()


@pytest.fixture
def executor(clock: StepClock) -> Iterator[Executor]:
    executor = SingleThreadedExecutor(context=Context(), clock=clock)
    yield executor
    executor.shutdown()
    executor.context.try_shutdown()


@pytest.fixture
def node(executor: Executor) -> Node:
    node = Node("n", context=executor.context)
    executor.add_node(node)
    return node


def in_a_thread(function: Callable[[], Any]) -> None:
    thread = threading.Thread(target=function)
    thread.start()
    thread.join()


def test_samples_that_were_replaced_leave_no_events(
    node: Node, executor: Executor, clock: StepClock
) -> None:
    """Another thread publishes 100 messages during each callback."""
    publisher = node.create_publisher(Int32, "count", DEPTH)
    received: list[int] = []
    waiting: list[int] = []
    sent = iter(range(10_000))

    def publish() -> None:
        for _ in range(100):
            publisher.publish(Int32(data=next(sent)))

    def receive(message: Int32) -> None:
        received.append(message.data)
        if len(received) <= 20:
            in_a_thread(publish)
        waiting.append(len(executor.loop.ready))

    node.create_subscription(Int32, "count", receive, DEPTH)
    publish()
    executor.spin_until(clock.now_ns)
    assert len(received) == 20 + DEPTH
    assert received[-DEPTH:] == list(range(2100 - DEPTH, 2100))
    assert max(waiting) <= DEPTH + 1


@pytest.mark.parametrize("work_ms", [30, 130])
def test_a_timer_takes_turns_with_the_messages_that_wait(
    node: Node, executor: Executor, clock: StepClock, work_ms: int
) -> None:
    """Also where it is late always: no side waits for the other one."""
    order: list[str] = []

    def work(name: str) -> None:
        order.append(name)
        clock.now_ns += work_ms * MS

    node.create_subscription(Int32, "count", lambda _: work("message"), 100)
    node.create_timer(0.1, lambda: work("timer"))
    publisher = node.create_publisher(Int32, "count", 100)
    for number in range(40):
        publisher.publish(Int32(data=number))
    executor.spin_until(clock.now_ns + 40 * work_ms * MS)
    ticks = order.count("timer")
    assert ticks >= min(len(order) * work_ms // 130, len(order) // 2 - 1)
    assert order.count("message") >= len(order) // 2 - 1


def test_one_parked_event_follows_each_callback_of_an_exclusive_group() -> None:
    executor = MultiThreadedExecutor(2, context=Context())
    node = Node("n", context=executor.context)
    executor.add_node(node)
    received: list[int] = []
    parked: list[int] = []

    def receive(message: Int32) -> None:
        received.append(message.data)
        parked.append(len(node.default_callback_group.parked))
        if len(received) == 200:
            executor.stop()

    node.create_subscription(Int32, "count", receive, 200)
    publisher = node.create_publisher(Int32, "count", 200)
    for number in range(200):
        publisher.publish(Int32(data=number))
    executor.spin()
    assert received == list(range(200))
    # The others stay parked: none is queued and parked again for each callback.
    assert parked[1:] == sorted(parked[1:], reverse=True)
    executor.shutdown()
    executor.context.try_shutdown()
