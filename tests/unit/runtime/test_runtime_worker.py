"""Computations beside the event loop, by the kind of clock."""

import gc
import threading
import weakref
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from navette.errors import CallbackError
from navette.runtime import Context, Executor, Node
from navette.runtime.clock import ContextClock, PacedClock, SystemClock, VirtualClock
from navette.runtime.worker import Worker

WAIT_S = 30.0


class Graph:
    """A node with a worker; :meth:`run` calls a function in a callback."""

    def __init__(self, clock: ContextClock) -> None:
        self.context = Context(clock=clock)
        self.node = Node("node", context=self.context)
        self.worker = Worker(self.node)
        self.executor = Executor(context=self.context)
        self.executor.add_node(self.node)
        self.results: list[Any] = []

    def run(self, start: Callable[[], Any], until: Callable[[], bool]) -> None:
        self.context.loop.call_soon(start)
        self.context.loop.run(done=until)


@pytest.fixture(params=[VirtualClock, PacedClock, SystemClock])
def graph(request: pytest.FixtureRequest) -> Iterator[Graph]:
    graph = Graph(request.param())
    with graph.context:
        yield graph
        graph.worker.close()


def test_the_result_arrives_in_the_loop(graph: Graph) -> None:
    threads = []

    def finish(result: int) -> None:
        threads.append(threading.get_ident())
        graph.results.append(result)

    graph.run(lambda: graph.worker.run(lambda: 7, finish), lambda: bool(graph.results))
    assert graph.results == [7]
    assert threads == [threading.get_ident()]


def test_what_a_computation_used_is_freed_without_the_collector(graph: Graph) -> None:
    """The arrays of a plan may be large."""

    class Used:
        pass

    kept: list[weakref.ref[Used]] = []

    def start() -> None:
        used = Used()
        kept.append(weakref.ref(used))
        graph.worker.run(lambda: used, lambda _: graph.results.append(1))

    gc.disable()
    try:
        for count in (1, 2, 3):
            graph.run(start, lambda count=count: len(graph.results) == count)
        assert [used() for used in kept[:-1]] == [None, None]
    finally:
        gc.enable()


def test_a_failed_computation_fails_in_the_loop(graph: Graph) -> None:
    def fail() -> None:
        raise ValueError("no result")

    with pytest.raises(CallbackError, match="no result"):
        graph.run(lambda: graph.worker.run(fail, print), lambda: False)


def test_a_coroutine_awaits_a_result_or_its_exception(graph: Graph) -> None:
    def fail() -> None:
        raise ValueError("no result")

    async def compute() -> None:
        graph.results.append(await graph.worker.submit(lambda: 7))
        with pytest.raises(ValueError, match="no result"):
            await graph.worker.submit(fail)
        graph.results.append(threading.get_ident())

    graph.run(
        lambda: graph.executor.create_task(compute), lambda: len(graph.results) == 2
    )
    assert graph.results == [7, threading.get_ident()]


@pytest.mark.parametrize("clock", [PacedClock, SystemClock])
def test_calls_of_other_threads_run_meanwhile(clock: type[ContextClock]) -> None:
    graph = Graph(clock())
    ran = threading.Event()
    times = []
    with graph.context:
        loop = graph.context.loop

        def compute() -> bool:
            loop.call_soon_threadsafe(ran.set)
            return ran.wait(WAIT_S)

        def start() -> None:
            times.append(graph.context.clock.now_ns)
            graph.worker.run(compute, finish)

        def finish(served: bool) -> None:
            times.append(graph.context.clock.now_ns)
            graph.results.append(served)

        graph.run(start, lambda: bool(graph.results))
        graph.worker.close()
    assert graph.results == [True]
    if graph.context.clock.is_paced:
        assert times[0] == times[1]


def test_paced_time_and_other_events_wait_for_the_result() -> None:
    graph = Graph(PacedClock(factor=1000.0))
    order: list[str] = []
    with graph.context:
        loop, gate = graph.context.loop, threading.Event()

        def start() -> None:
            loop.call_soon(lambda: order.append("ready before"))
            graph.node.create_timer(1e-6, lambda: order.append("timer"))
            loop.call_soon_threadsafe(from_outside)
            graph.worker.run(lambda: gate.wait(WAIT_S), lambda _: order.append("end"))

        def from_outside() -> None:
            order.append("call")
            loop.call_soon(follow)

        def follow() -> None:
            order.append("its result")
            gate.set()

        graph.run(start, lambda: "timer" in order)
        graph.worker.close()
    assert order[:4] == ["call", "its result", "end", "ready before"]


def test_a_dropped_computation_does_not_hold_the_paced_loop() -> None:
    graph = Graph(PacedClock())
    gate = threading.Event()
    dropped: list[bool] = []
    with graph.context:
        loop = graph.context.loop

        def start() -> None:
            loop.call_soon_threadsafe(lambda: dropped.append(True))
            graph.worker.run(
                lambda: gate.wait(WAIT_S),
                graph.results.append,
                is_dropped=lambda: bool(dropped),
            )
            graph.results.append("continued")

        graph.run(start, lambda: bool(graph.results))
        gate.set()
        graph.worker.close()
    assert graph.results == ["continued"]
