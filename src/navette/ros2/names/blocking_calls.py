"""``time.sleep`` and ``Event.wait`` in virtual time, under a MultiThreadedExecutor.

The executor's threads run other callbacks while one sleeps or waits, and programs
depend on it: an action's execute callback sleeps and can still be cancelled; a callback
calls a service and waits for a ``threading.Event`` that the response sets. In virtual
time all callbacks run in one thread (decision 0034). While a callback waits there, the
loop runs inside the call and holds back the callback's group (for an event except for
servers, as in a blocking call).
"""

import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import SupportsIndex

from navette.runtime import Context, MultiThreadedExecutor
from navette.runtime.context import current_scope

_sleep = time.sleep
_wait = threading.Event.wait
_set = threading.Event.set
#: Attribute of an event: the loop that waits for it.
_LOOP = "_navette_loop"


@contextmanager
def cooperative_blocking_calls() -> Iterator[None]:
    """Let callbacks run during blocking calls, in all threads, within this context."""
    time.sleep = _cooperative_sleep
    # mypy treats a function assigned to a class as a bound method.
    threading.Event.wait = _cooperative_wait  # type: ignore[method-assign, assignment]
    threading.Event.set = _set_and_wake  # type: ignore[method-assign, assignment]
    try:
        yield
    finally:
        time.sleep = _sleep
        threading.Event.wait = _wait  # type: ignore[method-assign]
        threading.Event.set = _set  # type: ignore[method-assign]


def _cooperative_sleep(seconds: float | SupportsIndex, /) -> None:
    context = _context_to_run()
    if context is None:
        _sleep(seconds)
        return
    # The context's clock counts: with a virtual clock no wall time passes.
    context.loop.run(until_ns=context.clock.now_ns + round(float(seconds) * 1e9))


def _cooperative_wait(event: threading.Event, timeout: float | None = None) -> bool:
    if event.is_set() or not _is_program(sys._getframe(1).f_globals):
        return _wait(event, timeout)
    context = _context_to_run()
    if context is None:
        return _wait(event, timeout)
    until_ns = None
    if timeout is not None:
        until_ns = context.clock.now_ns + round(max(0.0, timeout) * 1e9)
    setattr(event, _LOOP, context.loop)
    context.loop.run(until_ns=until_ns, done=event.is_set, calling=True)
    return event.is_set()


def _set_and_wake(event: threading.Event) -> None:
    _set(event)
    loop = getattr(event, _LOOP, None)
    if loop is not None:
        loop.wake()


def _is_program(names: dict[str, object]) -> bool:
    """Whether a module with these globals belongs neither to Python nor to Navette.

    Their own waits, such as for a thread's start, have no relation to callbacks.
    """
    top = str(names.get("__name__", "")).partition(".")[0]
    return top not in sys.stdlib_module_names and top != "navette"


def _context_to_run() -> Context | None:
    """Return the running callback's context if its node has a MultiThreadedExecutor."""
    for context in tuple(current_scope.get().contexts):
        if not context.loop.in_driver_thread:
            continue
        running = context.loop.running_node
        for node in context.nodes:
            if node.get_fully_qualified_name() == running and isinstance(
                node.executor, MultiThreadedExecutor
            ):
                return context
    return None
