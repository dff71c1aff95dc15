"""Threads of a MultiThreadedExecutor, in which callbacks run beside the loop.

The loop decides what runs and when: it takes an event, holds the event's group if that
is exclusive, and hands the callback to a thread. The end of a callback comes back to
the loop as a call, which releases the group or raises the callback's exception. All
state of groups thus changes in the thread that drives the loop.
"""

import threading
from collections.abc import Callable, Coroutine
from concurrent.futures import ThreadPoolExecutor
from contextvars import copy_context
from typing import Any, NoReturn, Protocol

from navette.runtime.callback_groups import CallbackGroup, ReentrantCallbackGroup
from navette.runtime.events import Entity
from navette.runtime.future import Scheduler, Task


class Loop(Scheduler, Protocol):
    """The part of the event loop that the threads use."""

    def call_soon_threadsafe(
        self, function: Callable[[], Any], source: str = "call", node: str = ""
    ) -> object: ...


class _Running(threading.local):
    """Group of the callback that runs in this thread."""

    group: CallbackGroup | None = None


_running = _Running()


def group_of_this_thread() -> CallbackGroup | None:
    """Return the group of the callback that runs in this thread, if it is one's."""
    return _running.group


class CallbackThreads:
    """A pool of threads for the callbacks of one executor.

    Args:
        loop: the loop whose events are run.
        count: number of threads, above zero.
    """

    def __init__(self, loop: Loop, count: int) -> None:
        self._loop = loop
        self._pool = ThreadPoolExecutor(count, "navette-callback")
        #: Group of the tasks that an executor runs without a group of their own.
        self.free_group = ReentrantCallbackGroup()
        self.free_group.run_in(self)

    def start(self, entity: Entity, rules: CallbackGroup | None) -> None:
        """Run an event in a thread; called by the loop once its group lets it start.

        ``rules`` is the group, if its own rules have let the event start.
        """
        group = entity.group
        if group.exclusive:
            group.hold()

        def finish() -> None:
            if group.exclusive:
                group.release()
            if rules is not None:
                rules.ending_execution(entity)

        # With the context variables of the program: they name its default context.
        self._pool.submit(copy_context().run, self._run, entity, finish)

    def post(self, function: Callable[[], Any]) -> None:
        """Run a function in the loop, between two events."""
        self._loop.call_soon_threadsafe(function)

    def shutdown(self, *, wait: bool) -> None:
        """Start no further callback; with ``wait``, return when those running end."""
        self._pool.shutdown(wait=wait and _running.group is None, cancel_futures=True)

    def _run(self, entity: Entity, finish: Callable[[], None]) -> None:
        _running.group = entity.waiting_group()
        try:
            result = entity.run()
            if isinstance(result, Coroutine):
                self._run_task(entity, result, finish)
                return
        except BaseException as error:
            self._report(entity, error)
        finally:
            _running.group = None
        self.post(finish)

    def _run_task(
        self,
        entity: Entity,
        coroutine: Coroutine[Any, Any, Any],
        finish: Callable[[], None],
    ) -> None:
        """Run a coroutine callback step by step, each in a thread."""
        node, source = entity.origin()
        task: Task[Any] = Task(coroutine, loop=self._loop, source=source, node=node)
        task.group = entity.group
        task.step_group = self.free_group

        def fail(error: Exception) -> None:
            self._report(entity, error)
            self.post(finish)

        task.on_error = fail
        task.add_done_callback(lambda _: finish())
        task()

    def _report(self, entity: Entity, error: BaseException) -> None:
        """Raise the exception in the thread that spins."""

        def reraise() -> NoReturn:
            raise error

        node, source = entity.origin()
        self._loop.call_soon_threadsafe(reraise, source, node)
