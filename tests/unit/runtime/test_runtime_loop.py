"""The event loop: order, nesting, threads, coroutines, errors."""

import asyncio
import gc
import threading
from collections.abc import Iterator

import pytest

from navette.errors import CallbackError, MessageError
from navette.runtime import Context, Executor, Future, Node, VirtualClock
from navette.runtime.callback_groups import (
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
)
from navette.runtime.loop import EventLoop


@pytest.fixture
def loop() -> EventLoop:
    return EventLoop(VirtualClock())


def test_events_run_by_time_then_by_order_of_creation(loop: EventLoop) -> None:
    order: list[str] = []
    for time_ns, name in ((20, "c"), (10, "a"), (20, "d"), (10, "b")):
        loop.call_at(time_ns, lambda name=name: order.append(name))
    loop.call_soon(lambda: order.append("now"))
    loop.run()
    assert order == ["now", "a", "b", "c", "d"]
    assert loop.clock.now_ns == 20


def test_an_event_for_the_current_time_runs_after_the_ready_events(
    loop: EventLoop,
) -> None:
    order: list[str] = []

    def first() -> None:
        order.append("first")
        loop.call_at(10, lambda: order.append("made at 10 for 10"))

    loop.call_at(10, first)
    loop.call_at(10, lambda: order.append("second"))
    loop.run()
    assert order == ["first", "second", "made at 10 for 10"]


def test_run_until_includes_the_end_time(loop: EventLoop) -> None:
    hits: list[int] = []
    for time_ns in (5, 10, 11):
        loop.call_at(time_ns, lambda t=time_ns: hits.append(t))
    loop.run(until_ns=10)
    assert (hits, loop.clock.now_ns) == ([5, 10], 10)
    loop.run(until_ns=100)
    assert (hits, loop.clock.now_ns) == ([5, 10, 11], 100)


def test_a_cancelled_call_neither_runs_nor_advances_time(loop: EventLoop) -> None:
    loop.call_at(50, lambda: pytest.fail("was canceled")).cancel()
    loop.run()
    assert loop.clock.now_ns == 0


def test_a_limit_counts_events(loop: EventLoop) -> None:
    hits: list[int] = []
    for number in range(3):
        loop.call_soon(lambda n=number: hits.append(n))
    loop.run(limit=2)
    assert hits == [0, 1]


def test_done_is_checked_between_events(loop: EventLoop) -> None:
    hits: list[int] = []
    for number in range(3):
        loop.call_soon(lambda n=number: hits.append(n))
    loop.run(done=lambda: len(hits) == 2)
    assert hits == [0, 1]
    loop.run()
    assert hits == [0, 1, 2]


def test_a_closed_loop_runs_no_events(loop: EventLoop) -> None:
    loop.call_soon(lambda: pytest.fail("must not run"))
    loop.close()
    loop.run()


def test_an_error_names_source_stamp_and_cause(loop: EventLoop) -> None:
    def bad() -> None:
        raise ValueError("broken")

    loop.call_at(1_500_000_000, bad, "my source", "/my_node")
    with pytest.raises(CallbackError, match="broken") as caught:
        loop.run()
    assert caught.value.node == "/my_node"
    assert caught.value.source == "my source"
    assert caught.value.stamp_ns == 1_500_000_000
    assert isinstance(caught.value.__cause__, ValueError)


def test_the_loop_can_run_again_after_an_error(loop: EventLoop) -> None:
    hits: list[str] = []

    def bad() -> None:
        raise ValueError("broken")

    loop.call_soon(bad)
    loop.call_soon(lambda: hits.append("after"))
    with pytest.raises(CallbackError):
        loop.run()
    loop.run()
    assert hits == ["after"]


def test_other_events_run_during_a_nested_run(loop: EventLoop) -> None:
    order: list[str] = []

    def waits() -> None:
        order.append("waits")
        loop.run(until_ns=loop.clock.now_ns + 10)
        order.append("waited")

    loop.call_at(5, waits)
    loop.call_at(8, lambda: order.append("meanwhile"))
    loop.call_at(30, lambda: order.append("later"))
    loop.run()
    assert order == ["waits", "meanwhile", "waited", "later"]


def test_error_inside_a_nested_run_is_wrapped_once(loop: EventLoop) -> None:
    def bad() -> None:
        raise ValueError("inner")

    def waits() -> None:
        loop.run(until_ns=100)

    loop.call_at(5, waits, "outer")
    loop.call_at(8, bad, "inner source")
    with pytest.raises(CallbackError) as caught:
        loop.run()
    assert caught.value.source == "inner source"
    assert isinstance(caught.value.__cause__, ValueError)
    assert not isinstance(caught.value.__cause__, CallbackError)


class _DemandingError(UnicodeError):
    """An exception that cannot be constructed without arguments."""

    def __new__(cls, code: int) -> "_DemandingError":
        return super().__new__(cls)

    def __init__(self, code: int) -> None:
        super().__init__(f"code {code}")
        self.code = code


class _FinalError(Exception):
    """An exception that cannot be subclassed."""

    def __init_subclass__(cls, *, allowed: bool) -> None:
        """Require a keyword argument of every subclass."""


@pytest.mark.parametrize(
    "error",
    [
        ValueError("bad"),
        KeyError("k"),
        FileNotFoundError(2, "gone", "/nowhere"),
        UnicodeDecodeError("utf-8", b"x", 0, 1, "why"),
        MessageError("field"),
        RuntimeError("plain"),
        Exception("any"),
        _DemandingError(7),
    ],
    ids=lambda error: type(error).__name__,
)
def test_an_except_clause_catches_the_callbacks_exception(
    loop: EventLoop, error: Exception
) -> None:
    def bad() -> None:
        raise error

    loop.call_at(5, bad, "a source", "/a_node")
    with pytest.raises(type(error)) as caught:
        loop.run()
    assert isinstance(caught.value, CallbackError)
    assert caught.value.original is caught.value.__cause__ is error
    text = str(caught.value)
    assert text.startswith("node /a_node: callback of a source raised at 0.000 s: ")
    assert text.endswith(f"{type(error).__name__}: {error}")


def test_the_error_has_the_original_attributes(loop: EventLoop) -> None:
    def bad() -> None:
        raise _DemandingError(7)

    loop.call_at(5, bad)
    with pytest.raises(_DemandingError) as caught:
        loop.run()
    assert caught.value.code == 7
    assert not hasattr(caught.value, "colour")


def test_an_exception_that_cannot_be_subclassed_is_the_cause(loop: EventLoop) -> None:
    def bad() -> None:
        raise _FinalError("end")

    loop.call_at(5, bad)
    with pytest.raises(CallbackError) as caught:
        loop.run()
    assert isinstance(caught.value.__cause__, _FinalError)


def test_call_from_another_thread_wakes_a_waiting_loop() -> None:
    # With the system clock and no events, the loop waits for a call.
    executor = Executor(clock=None, context=_context())
    arrived: list[int] = []

    def deliver() -> None:
        arrived.append(threading.get_ident())
        executor.stop()

    thread = threading.Thread(
        target=lambda: executor.call_soon_threadsafe(deliver), name="caller"
    )
    executor.call_soon_threadsafe(thread.start)
    executor.spin()
    thread.join()
    assert arrived == [threading.get_ident()]


def test_calls_of_other_threads_do_not_count_as_events() -> None:
    loop = EventLoop(VirtualClock())
    order: list[str] = []
    loop.call_soon(lambda: order.append("event"))
    loop.call_soon(lambda: order.append("later"))
    loop.call_soon_threadsafe(lambda: order.append("asked"))
    loop.run(limit=1)
    assert order == ["asked", "event"]


def test_one_thread_drives_and_the_other_gets_the_result() -> None:
    executor = Executor(context=_context())
    future: Future[str] = Future(executor=executor)
    spinning = threading.Event()
    executor.call_soon_threadsafe(spinning.set)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    assert spinning.wait(60.0)
    executor.call_soon_threadsafe(lambda: future.set_result("done"))
    executor.loop.run(done=future.done)
    assert future.result() == "done"
    executor.stop()
    thread.join(60.0)
    assert not thread.is_alive()


def _context() -> Context:
    context = Context()
    context.init(args=[])
    return context


@pytest.mark.parametrize("reentrant", [False, True])
def test_group_decides_what_may_start_while_a_callback_waits(reentrant: bool) -> None:
    context = Context(clock=VirtualClock())
    node = Node("n", context=context)
    executor = Executor(context=context)
    executor.add_node(node)
    order: list[str] = []
    group = ReentrantCallbackGroup() if reentrant else MutuallyExclusiveCallbackGroup()

    def slow() -> None:
        order.append("slow begins")
        timer_slow.cancel()
        executor.spin_for(1_000_000_000)
        order.append("slow ends")

    timer_slow = node.create_timer(1.0, slow, group)
    timer_same = node.create_timer(1.2, lambda: order.append("same group"), group)
    timer_other = node.create_timer(1.3, lambda: order.append("other group"))
    executor.spin_until(1_900_000_000)
    timer_same.cancel()
    timer_other.cancel()
    if reentrant:
        assert order == ["slow begins", "same group", "other group", "slow ends"]
    else:
        assert order == ["slow begins", "other group", "slow ends", "same group"]


def test_a_waiting_coroutine_does_not_block_others() -> None:
    context = Context(clock=VirtualClock())
    node = Node("n", context=context)
    executor = Executor(context=context)
    executor.add_node(node)
    order: list[str] = []
    answer: Future[int] = Future(executor=executor)

    async def call() -> None:
        timer.cancel()
        order.append("call")
        order.append(f"got {await answer}")

    timer = node.create_timer(1.0, call, ReentrantCallbackGroup())
    context.loop.call_at(2_000_000_000, lambda: answer.set_result(42))
    context.loop.call_at(1_500_000_000, lambda: order.append("meanwhile"))
    executor.spin_for(3_000_000_000)
    assert order == ["call", "meanwhile", "got 42"]


def test_a_suspended_coroutine_holds_its_exclusive_group() -> None:
    context = Context(clock=VirtualClock())
    node = Node("n", context=context)
    executor = Executor(context=context)
    executor.add_node(node)
    order: list[str] = []
    answer: Future[None] = Future(executor=executor)

    async def call() -> None:
        first.cancel()
        await answer
        order.append("resumed")

    first = node.create_timer(1.0, call)
    second = node.create_timer(1.5, lambda: (order.append("second"), second.cancel()))
    context.loop.call_at(2_000_000_000, lambda: answer.set_result(None))
    executor.spin_for(3_000_000_000)
    assert order == ["resumed", "second"]


def test_coroutine_that_raises_after_a_wait_stops_the_executor() -> None:
    context = Context(clock=VirtualClock())
    node = Node("n", context=context)
    executor = Executor(context=context)
    executor.add_node(node)
    answer: Future[None] = Future(executor=executor)

    async def fails() -> None:
        await answer
        raise ValueError("too late")

    node.create_timer(1.0, fails)
    context.loop.call_at(1_500_000_000, lambda: answer.set_result(None))
    with pytest.raises(CallbackError, match="too late") as caught:
        executor.spin_for(2_000_000_000)
    assert caught.value.node == "/n"
    assert caught.value.stamp_ns == 1_500_000_000


def test_a_task_has_a_result_and_can_be_awaited(loop: EventLoop) -> None:
    async def inner() -> int:
        return 20

    async def outer() -> int:
        return 1 + await loop.create_task(inner())

    task = loop.create_task(outer())
    loop.run()
    assert task.done()
    assert task.result() == 21


def test_an_error_of_a_task_is_raised_where_it_is_awaited(loop: EventLoop) -> None:
    async def inner() -> None:
        raise ValueError("inner")

    async def outer() -> str:
        try:
            await loop.create_task(inner())
        except ValueError as error:
            return f"caught {error}"
        return "missed"

    task = loop.create_task(outer())
    loop.run()
    assert task.result() == "caught inner"


def test_an_error_of_an_unawaited_task_stops_the_loop(loop: EventLoop) -> None:
    async def bad() -> None:
        raise ValueError("unseen")

    loop.create_task(bad())
    with pytest.raises(CallbackError, match="unseen"):
        loop.run()


def test_awaiting_a_foreign_awaitable_raises(loop: EventLoop) -> None:
    class Foreign:
        def __await__(self):  # type: ignore[no-untyped-def]
            yield "foreign"

    async def bad() -> None:
        await Foreign()

    loop.create_task(bad())
    with pytest.raises(CallbackError, match="cannot await str here"):
        loop.run()


def test_future_states(loop: EventLoop) -> None:
    seen: list[object] = []
    future: Future[int] = Future()
    future.add_done_callback(lambda f: seen.append(f.result()))
    future.set_result(3)
    future.add_done_callback(lambda f: seen.append("late"))
    assert seen == [3, "late"]
    canceled: Future[int] = Future()
    canceled.cancel()
    assert canceled.cancelled()
    assert canceled.done()
    failed: Future[int] = Future()
    failed.set_exception(ValueError("no"))
    with pytest.raises(ValueError, match="no"):
        failed.result()


class Turn:
    """Lets other asyncio tasks run."""

    def __await__(self) -> Iterator[None]:
        yield


def test_futures_are_awaited_by_asyncio_while_another_task_spins() -> None:
    """As in the asyncio client of the ROS 2 examples."""
    loop = EventLoop(VirtualClock())
    future: Future[str] = Future(executor=loop)
    never: Future[str] = Future(executor=loop)
    loop.call_at(5, lambda: future.set_result("done"))

    async def spin() -> None:
        while not future.done():
            loop.run(limit=1)
            await Turn()
        await Turn()
        loop.run()

    async def awaited_by_ours() -> str | None:
        return await future

    async def main() -> list[str | None]:
        given_up = asyncio.ensure_future(wait_for(never))
        task = loop.create_task(awaited_by_ours())
        found, _ = await asyncio.gather(wait_for(future), spin())
        given_up.cancel()
        never.set_result("too late")
        loop.run()
        return [found, task.result(), await wait_for(future)]

    async def wait_for(each: Future[str]) -> str | None:
        return await each

    assert asyncio.run(main()) == ["done"] * 3


def test_calls_of_other_threads_run_in_order(loop: EventLoop) -> None:
    """Also if each call wakes the loop while an earlier one runs."""
    done: list[int] = []

    def ask() -> None:
        for number in range(1, 6):
            loop.call_soon_threadsafe(lambda n=number: done.append(n))

    loop.call_soon_threadsafe(ask)
    loop.run(until_ns=0)
    assert done == [1, 2, 3, 4, 5]


def test_the_collector_skips_what_existed_before_the_first_event(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Context, "_has_exempted", False)  # the first of a process

    def is_traversed(node: Node) -> bool:
        return any(each is node for each in gc.get_objects())

    context = Context(clock=VirtualClock())
    context.init(args=[])
    node = Node("a", context=context)
    executor = Executor(context=context)
    executor.spin_for(1)
    later = Node("b", context=context)
    executor.spin_for(1)
    assert not is_traversed(node)
    assert is_traversed(later)
    context.shutdown()
    assert is_traversed(node)
