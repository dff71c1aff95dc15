"""Executors: sets of nodes whose callbacks the context's event loop runs.

Callbacks run one after the other, in the order of (time, sequence), in the thread that
spins. Only a MultiThreadedExecutor runs them in threads of its own, and not under a
virtual clock, where runs are deterministic.
"""

import os
import threading
from collections.abc import Callable, Coroutine
from functools import partial
from typing import Any, Self

from navette.errors import CallbackError, InvalidValueError
from navette.runtime.callback_threads import CallbackThreads
from navette.runtime.clock import ContextClock
from navette.runtime.context import Context, get_default_context
from navette.runtime.events import Call, Entity
from navette.runtime.exceptions import (
    ConditionReachedException,
    ExternalShutdownException,
    NotInitializedException,
    ShutdownException,
    TimeoutException,
)
from navette.runtime.future import Future, Task
from navette.runtime.loop import EventLoop
from navette.runtime.node import Node
from navette.runtime.strict_mode import check_wait


async def await_or_execute(
    callback: Callable[..., Any] | Coroutine[Any, Any, Any], *args: Any
) -> Any:
    """Return the result of a function, or of a coroutine after awaiting it."""
    result = callback(*args) if callable(callback) else callback
    return await result if isinstance(result, Coroutine) else result


class Executor:
    """Runs the callbacks of its nodes.

    Callbacks of a node run whenever the context's loop runs, if the node was added to
    any executor of the context.

    Args:
        context: the default context if None.
        clock: replaces the context's clock; the context must not have nodes yet.
    """

    def __init__(
        self, *, context: Context | None = None, clock: ContextClock | None = None
    ) -> None:
        if context is None and clock is not None:
            context = Context(clock=clock)
        self._context = context or get_default_context()
        if context is not None:
            context.init_if_needed()
        if not self._context.ok():
            raise NotInitializedException("cannot create an executor")
        if clock is not None:
            self._context.use_clock(clock)
        self._nodes: list[Node] = []
        self._stopping = False
        self._depth = 0  # number of nested spins
        self._idle = threading.Event()  # no spin runs
        self._idle.set()
        self._thread = 0  # that spins
        # Raised by a callback of a node here, while another thread drove the loop.
        self._error: CallbackError | SystemExit | None = None

    @property
    def context(self) -> Context:
        return self._context

    @property
    def threads(self) -> CallbackThreads | None:
        """The threads that run callbacks; None: the thread that spins."""
        return None

    @property
    def loop(self) -> EventLoop:
        """The context's event loop."""
        return self._context.loop

    @property
    def clock(self) -> ContextClock:
        return self._context.clock

    @property
    def now_ns(self) -> int:
        """The context's time in nanoseconds."""
        return self._context.clock.now_ns

    def add_node(self, node: Node) -> bool:
        """Let the node's callbacks run; False if it was added before.

        Raises:
            InvalidValueError: the node belongs to another context.
        """
        if node in self._nodes:
            return False
        if node.context is not self._context:
            raise InvalidValueError(
                f"node {node.get_fully_qualified_name()} belongs to another context "
                "than the executor"
            )
        if node.executor is not None:
            node.executor.remove_node(node)
        self._nodes.append(node)
        node._node_attach(self)
        self.loop.wake()
        return True

    def remove_node(self, node: Node) -> None:
        """Hold the node's callbacks."""
        if node in self._nodes:
            self._nodes.remove(node)
            node._node_detach()

    def get_nodes(self) -> list[Node]:
        return list(self._nodes)

    def spin(self) -> None:
        """Run until shutdown or :meth:`stop`, or no event is left (virtual clock)."""
        if type(self).spin_once is _OWN_SPIN_ONCE:
            self._run()
            return
        self._stopping = False
        while self._context.ok() and not self._stopping:
            self.spin_once()
        self._stopping = False

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Run one event, waiting at most ``timeout_sec`` (None: no limit).

        Raises:
            ExternalShutdownException: the context was shut down.
        """
        if not self._context.ok():
            raise ExternalShutdownException("the context was shut down")
        self._run(until_ns=self.loop.deadline_ns(timeout_sec), limit=1)

    def spin_until_future_complete(
        self, future: Future[Any], timeout_sec: float | None = None
    ) -> None:
        """Run until ``future`` is done or the timeout expires."""
        with future.waking(self.loop):
            self._run(until_ns=self.loop.deadline_ns(timeout_sec), done=future.done)

    def spin_once_until_future_complete(
        self, future: Future[Any], timeout_sec: float | None = None
    ) -> None:
        """Run one event, unless ``future`` is done first."""
        until_ns = self.loop.deadline_ns(timeout_sec)
        with future.waking(self.loop):
            self._run(until_ns=until_ns, done=future.done, limit=1)

    def can_execute(self, entity: Entity) -> bool:
        """Return whether the entity's group lets its callback start now."""
        return entity.group.can_execute(entity)

    def wait_for_ready_callbacks(
        self,
        timeout_sec: float | None = None,
        nodes: list[Node] | None = None,
        condition: Callable[[], bool] = lambda: False,
    ) -> tuple[Callable[[], None], Entity, Node | None]:
        """Wait for the next event; for subclasses that override :meth:`spin_once`.

        Returns:
            A function that runs the event (from any thread; callbacks still run one
            at a time), the entity, and its node (None if it has no node).

        Raises:
            TimeoutException: no event within the timeout.
            ConditionReachedException: the condition is true.
            ShutdownException: the executor was shut down.
            ExternalShutdownException: the context was shut down.
        """
        entity = self.loop.take(
            self.loop.deadline_ns(timeout_sec), lambda: self._stopping or condition()
        )
        if entity is not None:
            owner = entity.origin()[0]
            named = (n for n in self._nodes if n.get_fully_qualified_name() == owner)
            return partial(self.loop.execute, entity), entity, next(named, None)
        if not self._context.ok():
            raise ExternalShutdownException("the context was shut down")
        if self._stopping:
            raise ShutdownException("the executor was shut down")
        if condition():
            raise ConditionReachedException("the condition is true")
        raise TimeoutException("no callback became ready in time")

    def spin_until(self, time_ns: int) -> None:
        """Run all events up to and including ``time_ns``, the time afterwards."""
        self._run(until_ns=time_ns)

    def spin_for(self, duration_ns: int) -> None:
        """Run all events of the next ``duration_ns``."""
        self._run(until_ns=self.now_ns + duration_ns)

    def spin_until_complete(
        self,
        condition: Callable[[], bool] | Future[Any],
        timeout_ns: int | None = None,
    ) -> bool:
        """Run until the condition is true or the future done; return whether it is."""
        until_ns = None if timeout_ns is None else self.now_ns + timeout_ns
        if not isinstance(condition, Future):
            self._run(until_ns=until_ns, done=condition)
            return condition()
        with condition.waking(self.loop):
            self._run(until_ns=until_ns, done=condition.done)
        return condition.done()

    def stop(self) -> None:
        """Make running spins return after the current callback; from any thread."""
        self._stopping = True
        self.loop.wake()

    def wake(self) -> None:
        self.loop.wake()

    def call_soon_threadsafe(self, function: Callable[[], Any]) -> Call:
        """Run ``function`` between two callbacks; from any thread."""
        return self.loop.call_soon_threadsafe(function)

    def create_task(
        self,
        callback: Callable[..., Any] | Coroutine[Any, Any, Any],
        *args: Any,
        **kwargs: Any,
    ) -> Task[Any]:
        """Run a function or coroutine on the loop; the task is a future."""
        return self.loop.create_task(callback, *args, **kwargs)

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Stop, remove all nodes, and wait for a spin of another thread to end.

        Returns:
            False if its callback still runs after the timeout (None: no limit).
        """
        Executor.stop(self)  # a program's subclass may have a stop() of its own
        for node in tuple(self._nodes):
            self.remove_node(node)
        return self._thread == threading.get_ident() or self._idle.wait(timeout_sec)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc_info: object) -> None:
        self.shutdown()

    def _run(
        self,
        *,
        until_ns: int | None = None,
        done: Callable[[], bool] | None = None,
        limit: int | None = None,
    ) -> None:
        self._context.exempt_from_collection()
        if self._depth == 0:  # a nested spin must not clear the outer spin's stop
            self._stopping = False
        elif self.loop.in_driver_thread:
            check_wait("spin", in_driver_thread=True, same_group=False, exclusive=False)
        self._depth += 1
        self._idle.clear()
        outer, self._thread = self._thread, threading.get_ident()
        try:
            while not self._ran(until_ns, done, limit):
                pass
        finally:
            self._depth -= 1
            self._thread = outer
            if not self._depth:
                self._idle.set()

    def _ran(
        self,
        until_ns: int | None,
        done: Callable[[], bool] | None,
        limit: int | None,
    ) -> bool:
        """Run events; False if an executor of another thread gets an exception."""
        try:
            self.loop.run(
                until_ns=until_ns,
                done=done,
                limit=limit,
                stop=lambda: self._stopping or self._error is not None,
            )
        except (CallbackError, SystemExit) as error:
            owner = self._owner_of(error)
            if owner is None:
                raise
            owner._error = error
            owner.wake()
            return limit is not None  # then that event was all
        own, self._error = self._error, None
        if own is not None:
            raise own
        return True

    def _owner_of(self, error: CallbackError | SystemExit) -> "Executor | None":
        """Return the executor of another thread whose node's callback raised."""
        if isinstance(error, CallbackError):
            name = error.node
        elif self.loop.exit_of is not None and self.loop.exit_of[0] is error:
            name = self.loop.exit_of[1]
        else:
            return None
        for node in self._context.nodes:
            if node.get_fully_qualified_name() == name:
                owner: Executor | None = node.executor
                if owner is None or not owner._depth or owner._thread == self._thread:
                    return None
                return owner
        return None


#: If not overridden, :meth:`Executor.spin` runs events without calling it.
_OWN_SPIN_ONCE = Executor.spin_once


class SingleThreadedExecutor(Executor):
    """The deterministic executor, under rclpy's name."""


class MultiThreadedExecutor(Executor):
    """Runs callbacks in threads, as their callback groups allow.

    A callback that sleeps or waits does not delay those of other groups. Under a
    virtual clock there are no threads: callbacks run one at a time in a fixed order,
    and others run while one waits.

    Args:
        num_threads: number of threads; None: the number of processor cores, at least 2.
        context: as for :class:`Executor`.
        clock: as for :class:`Executor`.

    Raises:
        ValueError: ``num_threads`` is not positive.
    """

    def __init__(
        self,
        num_threads: int | None = None,
        *,
        context: Context | None = None,
        clock: ContextClock | None = None,
    ) -> None:
        super().__init__(context=context, clock=clock)
        if num_threads is None:
            num_threads = max(2, os.cpu_count() or 1)
        self._threads = CallbackThreads(self.loop, num_threads)

    @property
    def threads(self) -> CallbackThreads | None:
        return None if self.clock.is_virtual else self._threads

    def create_task(
        self,
        callback: Callable[..., Any] | Coroutine[Any, Any, Any],
        *args: Any,
        **kwargs: Any,
    ) -> Task[Any]:
        if self.threads is None:
            return super().create_task(callback, *args, **kwargs)
        group = self._threads.free_group
        return self.loop.create_task(callback, *args, step_group=group, **kwargs)

    def shutdown(
        self, timeout_sec: float | None = None, *, wait_for_threads: bool = True
    ) -> bool:
        """Stop, and remove all nodes; wait for the callbacks that are running."""
        stopped = super().shutdown(timeout_sec)
        self._threads.shutdown(wait=wait_for_threads)
        return stopped


class EventsExecutor(Executor):
    """The deterministic executor, under the name of rclpy's experimental executor."""


class TimeoutObject:
    """Holds a timeout in seconds."""

    def __init__(self, timeout: float) -> None:
        self.timeout = timeout
