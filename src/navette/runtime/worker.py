# SPDX-License-Identifier: Apache-2.0
"""Long computations of a node that do not hold the event loop."""

import functools
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, TypeVar

from navette.runtime.future import Future as LoopFuture
from navette.runtime.node import Node

T = TypeVar("T")


class Worker:
    """Runs computations of a node, one at a time; results arrive in the event loop.

    With the system clock, a computation runs in a thread while the loop continues.
    Under a virtual clock it runs in place, so that a run is deterministic. Under a
    paced clock it runs in a thread and virtual time stops, but calls of other threads
    (the live view, other processes) run: with the same calls the result is the same.

    A computation must not use the node or change what callbacks use.
    """

    def __init__(self, node: Node) -> None:
        self._loop = node.context.loop
        self._name = node.get_fully_qualified_name()
        self._threads: ThreadPoolExecutor | None = None
        self._last: Future[Any] | None = None
        self._closed = False

    @property
    def is_busy(self) -> bool:
        """Whether a computation runs in a thread, perhaps one that was dropped."""
        return self._last is not None and not self._last.done()

    def run(
        self,
        compute: Callable[[], T],
        finish: Callable[[T], None],
        *,
        is_dropped: Callable[[], bool] = lambda: False,
    ) -> None:
        """Call ``finish`` with the result of ``compute``, unless ``is_dropped``.

        The exception of a failed computation is raised in the event loop.
        """
        clock = self._loop.clock
        if not self._loop.in_driver_thread or clock.jumps:
            finish(compute())
            return
        if self._threads is None:
            self._threads = ThreadPoolExecutor(1, thread_name_prefix=self._name)
        future = self._threads.submit(compute)
        self._last = future

        # Gets the future: with a reference to it, what the computation used would be
        # kept, in a cycle, until the garbage collector finds it.
        def end(done: Future[T]) -> None:
            if not self._closed and not is_dropped():
                finish(done.result())

        if clock.is_virtual:
            future.add_done_callback(lambda _: self._loop.wake())
            self._loop.run_calls(lambda: future.done() or is_dropped())
            if future.done():
                end(future)
        else:
            self._call_when_done(future, end)

    def submit(self, compute: Callable[[], T]) -> "LoopFuture[T]":
        """Return the result of ``compute``, or its exception, to be awaited."""
        result: LoopFuture[T] = LoopFuture()

        def caught() -> Callable[[], None]:
            try:
                value = compute()
            except Exception as error:
                # The name of the clause ends with it.
                return functools.partial(result.set_exception, error)
            return lambda: result.set_result(value)

        self.run(caught, lambda end: end())
        return result

    def _call_when_done(
        self, future: "Future[T]", end: Callable[["Future[T]"], None]
    ) -> None:
        future.add_done_callback(
            lambda done: self._loop.call_soon_threadsafe(
                functools.partial(end, done), "worker", self._name
            )
        )

    def close(self) -> None:
        """Drop all results; wait for the computation that runs."""
        self._closed = True
        if self._threads is not None:
            self._threads.shutdown(cancel_futures=True)
