"""``time.sleep`` and ``Event.wait`` in a callback of a MultiThreadedExecutor.

On ROS 2 other threads of the executor go on meanwhile, and programs count on that: an
action's execute callback sleeps and is cancelled all the same; a callback asks a
service and waits for a ``threading.Event`` that the answer sets. Here one thread runs
all callbacks; while one of them waits, the loop goes on from inside it, with its
callback group held back (for an event but for servers, as in a blocking call).
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
#: An event's attribute: the loop that waits for it.
_LOOP = "_navette_loop"


@contextmanager
def sleeping_lets_others_run() -> Iterator[None]:
    """As long as the block runs; in all threads."""
    time.sleep = _sleep_in_callback
    # (mypy takes a class's function for a bound method here)
    threading.Event.wait = _wait_in_callback  # type: ignore[method-assign, assignment]
    threading.Event.set = _set_and_wake  # type: ignore[method-assign, assignment]
    try:
        yield
    finally:
        time.sleep = _sleep
        threading.Event.wait = _wait  # type: ignore[method-assign]
        threading.Event.set = _set  # type: ignore[method-assign]


def _sleep_in_callback(seconds: float | SupportsIndex, /) -> None:
    context = _context_that_goes_on()
    if context is None:
        _sleep(seconds)
        return
    # Under a virtual clock it is the clock's time that passes.
    context.loop.run(until_ns=context.clock.now_ns + round(float(seconds) * 1e9))


def _wait_in_callback(event: threading.Event, timeout: float | None = None) -> bool:
    if event.is_set() or not _is_programs(sys._getframe(1).f_globals):
        return _wait(event, timeout)
    context = _context_that_goes_on()
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


def _is_programs(names: dict[str, object]) -> bool:
    """Whether a module with these globals is no part of Python or Navette.

    Those wait for what has nothing to do with callbacks, such as a thread's start.
    """
    top = str(names.get("__name__", "")).partition(".")[0]
    return top not in sys.stdlib_module_names and top != "navette"


def _context_that_goes_on() -> Context | None:
    """That of the running callback, if its node has more than one thread on ROS 2."""
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
