"""Futures and tasks of the event loop."""

import sys
import threading
import warnings
from collections.abc import Callable, Coroutine, Generator, Iterator
from contextlib import contextmanager
from typing import Any, Generic, Protocol, TypeVar

from navette.runtime.callback_groups import CallbackGroup

T = TypeVar("T")


class Scheduler(Protocol):
    """The part of the event loop that futures and tasks use."""

    def call_soon(
        self,
        function: Callable[[], Any],
        source: str = "call",
        node: str = "",
        group: CallbackGroup | None = None,
    ) -> object: ...
    def wake(self) -> None: ...


class Future(Generic[T]):
    """The result of a pending operation; await it or add a done callback.

    Args:
        executor: schedules the done callbacks (an Executor or the loop itself).
            Without one, the thread that sets the result calls them at once.
    """

    #: Whether a service of the awaiting coroutine's own callback group may have to
    #: respond before this future is done.
    awaits_service = False

    def __init__(self, *, executor: Any = None) -> None:
        self._done = False
        self._cancelled = False
        self._result: T | None = None
        self._exception: BaseException | None = None
        self._callbacks: list[Callable[[Future[T]], object]] = []
        self._lock = threading.Lock()
        self._loop: Scheduler | None = None
        self._waiting: list[Scheduler] = []
        self._set_executor(executor)

    def __await__(self) -> Generator[Any, None, T | None]:
        if not self._done:
            waiter = _asyncio_waiter(self)
            if waiter is None:
                yield self
            else:
                yield from waiter
        return self.result()

    def cancel(self) -> None:
        """Cancel the operation; without effect if the future is done."""
        with self._lock:
            if self._done:
                return
            self._cancelled = self._done = True
        self._run_callbacks()

    def cancelled(self) -> bool:
        return self._cancelled

    def done(self) -> bool:
        """Whether a result or an exception is set, or the future was cancelled."""
        return self._done

    def result(self) -> T | None:
        """Return the result (None if not done), or raise the exception that was set."""
        if self._exception is not None:
            raise self._exception
        return self._result

    def exception(self) -> BaseException | None:
        return self._exception

    def set_result(self, result: T) -> None:
        """Set the result and finish; callable from any thread."""
        with self._lock:
            self._result = result
            self._done, self._cancelled = True, False
        self._run_callbacks()

    def set_exception(self, exception: BaseException) -> None:
        """Set the exception and finish; callable from any thread."""
        with self._lock:
            self._exception = exception
            self._done, self._cancelled = True, False
        self._run_callbacks()

    @property
    def has_done_callbacks(self) -> bool:
        """Whether done callbacks are registered."""
        return bool(self._callbacks)

    def add_done_callback(self, callback: Callable[["Future[T]"], object]) -> None:
        """Schedule ``callback(future)`` for when the future is done."""
        with self._lock:
            if not self._done:
                self._callbacks.append(callback)
                return
        self._schedule(callback)

    def remove_done_callback(self, callback: Callable[["Future[T]"], object]) -> bool:
        """Remove a done callback; False if it is not registered or was scheduled."""
        with self._lock:
            found = callback in self._callbacks
            if found:
                self._callbacks.remove(callback)
            return found

    @contextmanager
    def waking(self, loop: Scheduler) -> Iterator[None]:
        """Wake a loop that waits for the future when it is done."""
        self._waiting.append(loop)
        try:
            yield
        finally:
            self._waiting.remove(loop)

    def _run_callbacks(self) -> None:
        with self._lock:
            callbacks, self._callbacks = self._callbacks, []
        for callback in callbacks:
            self._schedule(callback)
        if self._loop is not None:
            self._loop.wake()
        for loop in (*self._waiting,):
            loop.wake()

    def _schedule(self, callback: Callable[["Future[T]"], object]) -> None:
        if self._loop is not None:
            self._loop.call_soon(lambda: callback(self), "future")
            return
        try:
            callback(self)
        except Exception as error:
            # As in rclpy: the other callbacks are called, and the setter of the result
            # continues.
            warnings.warn(
                f"exception in a done callback: {error!r}", RuntimeWarning, stacklevel=2
            )

    def _set_executor(self, executor: Any) -> None:
        self._loop = getattr(executor, "loop", executor)


class ResponseFuture(Future[T]):
    """The response of a service or an action server."""

    awaits_service = True


class _Stepping(threading.local):
    """Number of nested task steps that run in this thread."""

    depth = 0


_stepping = _Stepping()


def _asyncio_waiter(future: Future[Any]) -> Any:
    """Return an asyncio future that follows ``future``; None outside of asyncio.

    An asyncio program can spin in one task and await Navette's futures in another.
    """
    asyncio = sys.modules.get("asyncio")
    if asyncio is None or _stepping.depth:
        return None
    try:
        loop = asyncio.get_running_loop()
    except RuntimeError:
        return None
    waiter = loop.create_future()

    def finish() -> None:
        if not waiter.done():
            waiter.set_result(None)

    def finish_in_asyncio(_: object) -> None:
        if not loop.is_closed():
            loop.call_soon_threadsafe(finish)

    future.add_done_callback(finish_in_asyncio)
    return waiter


class Task(Future[T]):
    """A coroutine (or function) that the event loop runs step by step.

    Awaiting a :class:`Future` resumes once that future is done; a bare ``yield`` (as
    in ``asyncio.sleep(0)``) runs all other ready events first.
    """

    #: The task may await a service; its coroutine is not inspected.
    awaits_service = True

    def __init__(
        self,
        handler: Callable[..., Any] | Coroutine[Any, Any, T],
        args: tuple[Any, ...] = (),
        kwargs: dict[str, Any] | None = None,
        *,
        loop: Scheduler,
        source: str = "task",
        node: str = "",
    ) -> None:
        super().__init__(executor=loop)
        self._handler = handler
        self._arguments = (args, kwargs or {})
        self._coroutine: Coroutine[Any, Any, T] | None = None
        self._executing = False
        self._is_due = False  # for its next step, while another thread ends this one
        self.source = source
        self.node = node
        #: The group whose threads run the steps; None: the thread that spins.
        self.step_group: CallbackGroup | None = None
        #: The callback group that is held until the task ends; set by the loop.
        self.group: CallbackGroup | None = None
        # The group whose servers may run while the task awaits a response.
        self._calling: CallbackGroup | None = None
        #: Handles an exception that no other code would receive; set by the loop.
        self.on_error: Callable[[Exception], None] | None = None
        if isinstance(handler, Coroutine):
            self._coroutine = handler

    def executing(self) -> bool:
        """Whether a step of the task is running."""
        return self._executing

    def __call__(self) -> None:
        """Run until the next ``await`` or the end."""
        self._end_call()
        with self._lock:
            if self._done or self._executing:
                self._is_due = not self._done
                return
            self._executing = True
        try:
            self._step()
        except StopIteration as stop:
            self.set_result(stop.value)
        except Exception as error:  # a coroutine may raise anything
            if self.on_error is None:
                self.set_exception(error)
            else:
                self.on_error(error)
        finally:
            with self._lock:
                self._executing = False
                is_due, self._is_due = self._is_due, False
            if is_due:
                self._resume()

    def cancel(self) -> None:
        super().cancel()
        self._end_call()
        if self._coroutine is not None and not self._executing:
            self._coroutine.close()

    def _step(self) -> None:
        if self._coroutine is None:
            args, kwargs = self._arguments
            result = self._handler(*args, **kwargs)  # type: ignore[operator] # not a coroutine here
            if not isinstance(result, Coroutine):
                self.set_result(result)
                return
            self._coroutine = result
        _stepping.depth += 1
        try:
            awaited = self._coroutine.send(None)
        finally:
            _stepping.depth -= 1
        if isinstance(awaited, Future):
            if awaited.awaits_service and self.group is not None:
                self._calling = self.group
                self._calling.begin_call()
            awaited.add_done_callback(self._resume)
        elif awaited is None:
            self._resume()
        else:
            # Raised inside the coroutine so that the traceback shows the line.
            self._coroutine.throw(
                TypeError(
                    f"cannot await {type(awaited).__name__} here: the event loop "
                    "accepts Navette's futures and tasks, not asyncio's"
                )
            )

    def _end_call(self) -> None:
        calling, self._calling = self._calling, None
        if calling is not None:
            calling.end_call()

    def _resume(self, _: object = None) -> None:
        if self._loop is not None:
            self._loop.call_soon(self, self.source, self.node, self.step_group)
