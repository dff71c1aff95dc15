"""Callbacks in the threads of a MultiThreadedExecutor, under the system clock."""

import queue
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future as ConcurrentFuture
from typing import Any

import pytest

from navette.errors import CallbackError, InvalidValueError
from navette.msgs.example_interfaces.action import Fibonacci
from navette.msgs.std_msgs.msg import Int32
from navette.msgs.std_srvs.srv import Trigger
from navette.runtime import (
    ActionClient,
    ActionServer,
    CancelResponse,
    Clock,
    Context,
    Duration,
    Executor,
    Future,
    MultiThreadedExecutor,
    MutuallyExclusiveCallbackGroup,
    Node,
    ReentrantCallbackGroup,
    SingleThreadedExecutor,
    VirtualClock,
)
from navette.runtime.exceptions import ROSInterruptException

LIMIT_S = 20.0  # reached by a defect only


@pytest.fixture
def executor() -> Iterator[MultiThreadedExecutor]:
    executor = MultiThreadedExecutor(4, context=Context())
    yield executor
    executor.shutdown()
    executor.context.try_shutdown()


@pytest.fixture
def node(executor: MultiThreadedExecutor) -> Node:
    node = Node("n", context=executor.context)
    executor.add_node(node)
    return node


def run_until(executor: Executor, future: Any) -> None:
    executor.spin_until_future_complete(future, LIMIT_S)
    assert future.done()


def once(node: Node, function: Callable[[], Any], group: Any) -> Future[Any]:
    """Run a function once in a callback; return the future of its result."""
    done: Future[Any] = Future(executor=node.context.loop)

    def call() -> None:
        timer.cancel()
        done.set_result(function())

    timer = node.create_timer(0.001, call, callback_group=group)
    return done


def test_callbacks_of_different_groups_run_at_the_same_time(
    executor: MultiThreadedExecutor, node: Node
) -> None:
    both = threading.Barrier(2)
    ends = [
        once(node, lambda: both.wait(LIMIT_S), MutuallyExclusiveCallbackGroup())
        for _ in range(2)
    ]
    for end in ends:
        run_until(executor, end)
    assert sorted(end.result() for end in ends) == [0, 1]


def test_a_reentrant_callback_overlaps_itself(
    executor: MultiThreadedExecutor, node: Node
) -> None:
    both, met = threading.Barrier(2), Future[bool](executor=executor)

    def call() -> None:
        both.wait(LIMIT_S)
        timer.cancel()
        met.set_result(True)

    timer = node.create_timer(0.001, call, callback_group=ReentrantCallbackGroup())
    run_until(executor, met)


def test_callbacks_of_an_exclusive_group_never_overlap(
    executor: MultiThreadedExecutor, node: Node
) -> None:
    inside, most, left = [0], [0], [200]
    done = Future[bool](executor=executor)

    def call(_: Int32 | None = None) -> None:
        inside[0] += 1
        most[0] = max(most[0], inside[0])
        threading.Event().wait(0.0002)  # lets other threads run
        inside[0] -= 1
        left[0] -= 1
        if left[0] == 0:
            done.set_result(True)

    for _ in range(3):
        node.create_timer(0.0005, call)
    node.create_subscription(Int32, "/t", call, 10)
    publisher = node.create_publisher(Int32, "/t", 10)
    node.create_timer(
        0.0005, lambda: publisher.publish(Int32()), ReentrantCallbackGroup()
    )
    run_until(executor, done)
    assert most == [1]


@pytest.mark.parametrize("way", ["condition", "queue", "concurrent future"])
def test_a_callback_waits_for_what_another_provides(
    executor: MultiThreadedExecutor, node: Node, way: str
) -> None:
    condition, values = threading.Condition(), queue.Queue[int]()
    later: ConcurrentFuture[int] = ConcurrentFuture()

    def provide() -> None:
        values.put(1)
        later.set_result(1)
        with condition:
            condition.notify_all()

    def wait() -> bool:
        once(node, provide, MutuallyExclusiveCallbackGroup())
        if way == "condition":
            with condition:
                return condition.wait_for(lambda: not values.empty(), LIMIT_S)
        if way == "queue":
            return values.get(timeout=LIMIT_S) == 1
        return later.result(LIMIT_S) == 1

    end = once(node, wait, None)
    run_until(executor, end)
    assert end.result()


def test_a_callback_calls_a_service_of_its_own_group(
    executor: MultiThreadedExecutor, node: Node
) -> None:
    """It would wait forever in rclpy (decision 0021)."""
    node.create_service(Trigger, "s", lambda request, response: response)
    client = node.create_client(Trigger, "s")
    end = once(node, lambda: client.call(Trigger.Request(), LIMIT_S), None)
    run_until(executor, end)
    assert end.result() == Trigger.Response()


def test_a_coroutine_awaits_and_continues(
    executor: MultiThreadedExecutor, node: Node
) -> None:
    other = Node("other", context=executor.context)
    executor.add_node(other)
    other.create_service(Trigger, "s", lambda request, response: response)
    client = node.create_client(Trigger, "s")
    replies: list[Any] = []
    done = Future[bool](executor=executor)

    async def call() -> None:
        replies.append(await client.call_async(Trigger.Request()))
        if len(replies) == 50:
            timer.cancel()
            done.set_result(True)

    timer = node.create_timer(0.0001, call)
    run_until(executor, done)
    assert replies == [Trigger.Response()] * len(replies)


def test_a_task_runs_in_a_thread(executor: MultiThreadedExecutor, node: Node) -> None:
    task = executor.create_task(threading.get_ident)
    run_until(executor, task)
    assert task.result() != threading.get_ident()


def test_a_goal_is_cancelled_while_its_callback_waits(
    executor: MultiThreadedExecutor, node: Node
) -> None:
    cancelled = threading.Event()

    def execute(goal: Any) -> Fibonacci.Result:
        assert cancelled.wait(LIMIT_S)
        goal.canceled()
        return Fibonacci.Result()

    def accept(_: Any) -> CancelResponse:
        cancelled.set()
        return CancelResponse.ACCEPT

    ActionServer(node, Fibonacci, "fib", execute, cancel_callback=accept)
    client: Any = ActionClient(node, Fibonacci, "fib")
    sent = client.send_goal_async(Fibonacci.Goal(order=3))
    run_until(executor, sent)
    run_until(executor, sent.result().cancel_goal_async())
    result = sent.result().get_result_async()
    run_until(executor, result)
    assert result.result().status == 5  # STATUS_CANCELED


@pytest.mark.parametrize("is_coroutine", [False, True])
def test_an_exception_is_raised_by_the_spin(
    executor: MultiThreadedExecutor, node: Node, is_coroutine: bool
) -> None:
    def fail() -> None:
        raise ValueError("motor gone")

    async def fail_later() -> None:
        fail()

    node.create_timer(0.001, fail_later if is_coroutine else fail)
    with pytest.raises(CallbackError, match=r"node /n: .*timer of 0.001 s.*motor gone"):
        executor.spin()


def test_a_callback_ends_the_program(
    executor: MultiThreadedExecutor, node: Node
) -> None:
    def leave() -> None:
        raise SystemExit(3)

    node.create_timer(0.001, leave)
    with pytest.raises(SystemExit):
        executor.spin()


def test_shutdown_waits_for_running_callbacks(
    executor: MultiThreadedExecutor, node: Node
) -> None:
    started, may_end, ended = threading.Event(), threading.Event(), []

    def call() -> None:
        started.set()
        may_end.wait(LIMIT_S)
        ended.append(True)

    node.create_timer(0.001, call)
    while not started.is_set():
        executor.spin_once(0.01)
    threading.Timer(0.01, may_end.set).start()
    executor.shutdown()
    assert ended == [True]


def test_a_callback_of_a_node_that_moved_runs_in_the_thread_that_spins(
    executor: MultiThreadedExecutor, node: Node
) -> None:
    single = Executor(context=executor.context)
    single.add_node(node)
    end = once(node, threading.get_ident, None)
    run_until(single, end)
    assert end.result() == threading.get_ident()


def test_a_virtual_clock_has_no_threads() -> None:
    executor = MultiThreadedExecutor(context=Context(clock=VirtualClock()))
    node = Node("n", context=executor.context)
    executor.add_node(node)
    end = once(node, threading.get_ident, ReentrantCallbackGroup())
    executor.spin_until_future_complete(end)
    assert end.result() == threading.get_ident()
    executor.context.try_shutdown()


def test_a_destroyed_rate_wakes_the_thread_that_sleeps(
    executor: MultiThreadedExecutor, node: Node
) -> None:
    rate = node.create_rate(0.001)

    def sleep() -> str:
        with pytest.raises(ROSInterruptException):
            rate.sleep()
        return "woken"

    end = once(node, sleep, None)
    once(node, lambda: node.destroy_rate(rate), ReentrantCallbackGroup())
    run_until(executor, end)
    assert end.result() == "woken"


def test_a_clock_sleeps_in_another_context_than_its_own() -> None:
    context = Context()
    context.init()
    clock = Clock()
    assert clock.sleep_for(Duration(seconds=0.001), context=context)
    context.shutdown()


def test_a_timer_without_period_fires_at_every_spin(
    executor: MultiThreadedExecutor,
) -> None:
    single, ran = Executor(context=executor.context), []
    node = Node("n", context=executor.context)
    single.add_node(node)
    node.create_timer(0.0, lambda: ran.append(True))
    while len(ran) < 5:
        single.spin_once(LIMIT_S)


def test_virtual_time_refuses_a_timer_without_period() -> None:
    node = Node("n", context=Context(clock=VirtualClock()))
    with pytest.raises(InvalidValueError, match="virtual time would not advance"):
        node.create_timer(0.0, lambda: None)
    node.context.try_shutdown()


def test_a_pool_needs_a_thread() -> None:
    with pytest.raises(ValueError, match="max_workers"):
        MultiThreadedExecutor(0, context=Context())


@pytest.mark.parametrize("error", [SystemExit(5), ZeroDivisionError("half")])
def test_an_exception_ends_the_spin_of_its_own_node(error: BaseException) -> None:
    """The executor of another thread, which runs the callback, continues."""
    context = Context()
    main, helper = (SingleThreadedExecutor(context=context) for _ in range(2))
    nodes = [Node(name, context=context) for name in ("main", "helper")]
    for executor, node in zip((main, helper), nodes, strict=True):
        executor.add_node(node)
    ends: queue.SimpleQueue[str] = queue.SimpleQueue()

    def fail() -> None:
        raise error

    def spin() -> None:
        helper.spin()
        ends.put("stopped")

    thread = threading.Thread(target=spin)
    thread.start()
    while not context.loop.is_running:
        pass
    nodes[0].create_timer(0.001, fail)
    with pytest.raises(type(error)):
        main.spin()
    assert ends.empty()
    assert thread.is_alive()
    main.remove_node(nodes[0])
    helper.stop()
    assert ends.get(timeout=LIMIT_S) == "stopped"
    thread.join()
    context.shutdown()


def test_shutdown_waits_for_a_callback_of_another_thread() -> None:
    context = Context()
    executor = SingleThreadedExecutor(context=context)
    node = Node("n", context=context)
    executor.add_node(node)
    begun, may_end = threading.Event(), threading.Event()

    def callback() -> None:
        begun.set()
        may_end.wait(LIMIT_S)

    node.create_timer(0.001, callback)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    assert begun.wait(LIMIT_S)
    assert not executor.shutdown(timeout_sec=0.001)
    may_end.set()
    assert executor.shutdown()
    thread.join()
    context.shutdown()
