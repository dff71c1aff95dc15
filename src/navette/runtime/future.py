"""Futures and tasks on the deterministic loop."""

import sys
import threading
from collections.abc import Callable, Coroutine, Generator
from typing import TYPE_CHECKING, Any, Generic, TypeVar

if TYPE_CHECKING:
    from navette.runtime.callback_groups import CallbackGroup
    from navette.runtime.loop import EventLoop

T = TypeVar("T")


class Future(Generic[T]):
    """A result that will be there later; await it or add a callback.

    Args:
        executor: schedules the done callbacks (an Executor or the loop itself);
            without one they are called at once by whoever sets the result.
    """

    #: Whether a service may have to answer first, perhaps one of the very group whose
    #: coroutine awaits this.
    awaits_service = False

    def __init__(self, *, executor: Any = None) -> None:
        self._done = False
        self._cancelled = False
        self._result: T | None = None
        self._exception: BaseException | None = None
        self._callbacks: list[Callable[[Future[T]], object]] = []
        self._lock = threading.Lock()
        self._loop: EventLoop | None = None
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
        """Give up, unless it is done already."""
        with self._lock:
            if self._done:
                return
            self._cancelled = self._done = True
        self._run_callbacks()

    def cancelled(self) -> bool:
        return self._cancelled

    def done(self) -> bool:
        """Whether there is a result or an exception, or it was cancelled."""
        return self._done

    def result(self) -> T | None:
        """The result (None if not done); raises the exception if one was set."""
        if self._exception is not None:
            raise self._exception
        return self._result

    def exception(self) -> BaseException | None:
        return self._exception

    def set_result(self, result: T) -> None:
        """Finish with a result; from any thread."""
        with self._lock:
            self._result = result
            self._done, self._cancelled = True, False
        self._run_callbacks()

    def set_exception(self, exception: BaseException) -> None:
        """Finish with an exception; from any thread."""
        with self._lock:
            self._exception = exception
            self._done, self._cancelled = True, False
        self._run_callbacks()

    @property
    def has_done_callbacks(self) -> bool:
        """Whether somebody waits to be told."""
        return bool(self._callbacks)

    def add_done_callback(self, callback: Callable[["Future[T]"], object]) -> None:
        """Call ``callback(future)`` once done; soon, if it is already."""
        with self._lock:
            if not self._done:
                self._callbacks.append(callback)
                return
        self._schedule(callback)

    def _run_callbacks(self) -> None:
        with self._lock:
            callbacks, self._callbacks = self._callbacks, []
        for callback in callbacks:
            self._schedule(callback)
        if self._loop is not None:
            self._loop.wake()

    def _schedule(self, callback: Callable[["Future[T]"], object]) -> None:
        if self._loop is None:
            callback(self)
        else:
            self._loop.call_soon(lambda: callback(self), "future")

    def _set_executor(self, executor: Any) -> None:
        self._loop = getattr(executor, "loop", executor)


class Answer(Future[T]):
    """What a service or an action gives, now or later."""

    awaits_service = True


class _Stepping(threading.local):
    """How many of our tasks take a step in this thread, one inside another."""

    depth = 0


_stepping = _Stepping()


def _asyncio_waiter(future: Future[Any]) -> Any:
    """What an asyncio task waits on until ``future`` is done; None outside of one.

    Such a program spins in one asyncio task and awaits our futures in another.
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

    def tell(_: object) -> None:
        if not loop.is_closed():
            loop.call_soon_threadsafe(finish)

    future.add_done_callback(tell)
    return waiter


class Task(Future[T]):
    """A coroutine (or function) that the loop runs to its end, step by step.

    Awaiting a :class:`Future` resumes once it is done; a bare ``yield`` (as in
    ``asyncio.sleep(0)``) lets everything else that is ready go first.
    """

    #: What it waits for may be an answer; nobody looks.
    awaits_service = True

    def __init__(
        self,
        handler: Callable[..., Any] | Coroutine[Any, Any, T],
        args: tuple[Any, ...] = (),
        kwargs: dict[str, Any] | None = None,
        *,
        loop: "EventLoop",
        source: str = "task",
        node: str = "",
    ) -> None:
        super().__init__(executor=loop)
        self._handler = handler
        self._arguments = (args, kwargs or {})
        self._coroutine: Coroutine[Any, Any, T] | None = None
        self._executing = False
        self.source = source
        self.node = node
        #: The callback group that is held until it ends; set by the loop.
        self.group: CallbackGroup | None = None
        self._calling: CallbackGroup | None = None  # whose servers may answer it
        #: Called with an exception nobody else would see; set by the loop.
        self.on_error: Callable[[Exception], None] | None = None
        if isinstance(handler, Coroutine):
            self._coroutine = handler

    def executing(self) -> bool:
        """Whether one of its steps is running right now."""
        return self._executing

    def __call__(self) -> None:
        """Run until the next wait, or to the end."""
        self._end_call()
        if self._done or self._executing:
            return
        self._executing = True
        try:
            self._step()
        except StopIteration as stop:
            self.set_result(stop.value)
        except Exception as error:
            if self.on_error is None:
                self.set_exception(error)
            else:
                self.on_error(error)
        finally:
            self._executing = False

    def cancel(self) -> None:
        super().cancel()
        self._end_call()
        if self._coroutine is not None and not self._executing:
            self._coroutine.close()

    def _step(self) -> None:
        if self._coroutine is None:
            args, kwargs = self._arguments
            result = self._handler(*args, **kwargs)  # type: ignore[operator]
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
            # Thrown into the coroutine, so that its traceback shows the line.
            self._coroutine.throw(
                TypeError(
                    f"cannot await {type(awaited).__name__} here: only Navette's "
                    "futures and tasks run on this loop (not asyncio's)"
                )
            )

    def _end_call(self) -> None:
        calling, self._calling = self._calling, None
        if calling is not None:
            calling.end_call()

    def _resume(self, _: object = None) -> None:
        if self._loop is not None:
            self._loop.call_soon(self, self.source, self.node)
