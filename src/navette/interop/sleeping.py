"""``time.sleep`` in a callback of a MultiThreadedExecutor: others run meanwhile.

ROS 2's examples sleep in an action's execute callback and count on other threads of the
executor for feedback and cancelling. Here one thread runs all callbacks; while one of
them sleeps, the loop goes on from inside it, with its callback group held back.
"""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import SupportsIndex

from navette.runtime import Context, MultiThreadedExecutor
from navette.runtime.context import current_scope

_sleep = time.sleep


@contextmanager
def sleeping_lets_others_run() -> Iterator[None]:
    """As long as the block runs; in all threads."""
    time.sleep = _sleep_in_callback
    try:
        yield
    finally:
        time.sleep = _sleep


def _sleep_in_callback(seconds: float | SupportsIndex, /) -> None:
    context = _context_that_goes_on()
    if context is None:
        _sleep(seconds)
        return
    # Under a virtual clock it is the clock's time that passes.
    context.loop.run(until_ns=context.clock.now_ns + round(float(seconds) * 1e9))


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
