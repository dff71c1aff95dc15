"""When a program's nodes are made and spin: what it was given is looked through then.

Who started it may want to know, as with systemd's services: it passes a pipe, and its
number in the environment.
"""

import contextlib
import os
import threading
from collections.abc import Callable
from functools import partial

from navette.ros2.names.unused_arguments import warn_of_leftovers
from navette.runtime.context import Context, Scope

VARIABLE = "NAVETTE_READY_FD"
# Many programs that start at once are not to be slowed down by looking at each.
_FIRST_LOOK_S, _LONGEST_LOOK_S = 0.01, 0.16


class Readiness:
    """Tells, once, when all programs of a process are ready; if asked to.

    Args:
        programs: how many there are.
    """

    def __init__(self, programs: int = 1) -> None:
        number = os.environ.pop(VARIABLE, "")
        self._pipe = int(number) if number.isdigit() else None
        self._left = programs
        self._lock = threading.Lock()

    def one_is_ready(self) -> None:
        """From any thread."""
        with self._lock:
            self._left -= 1
            if self._left or self._pipe is None:
                return
            # Whoever asked may be gone by now.
            with contextlib.suppress(OSError):
                os.write(self._pipe, b"ready")
                os.close(self._pipe)


def watch_start(
    scope: Scope,
    is_over: Callable[[], bool],
    on_ready: Callable[[], object] | None = None,
) -> None:
    """Look, from a thread, until a context of the scope has nodes and runs."""
    thread = threading.Thread(target=_watch, args=(scope, is_over, on_ready))
    thread.daemon = True
    thread.start()


def _watch(
    scope: Scope,
    is_over: Callable[[], bool],
    on_ready: Callable[[], object] | None,
) -> None:
    pause, look_s = threading.Event(), _FIRST_LOOK_S
    while not (ready := _ready_contexts(scope)):
        if is_over():
            return
        pause.wait(look_s)
        look_s = min(2 * look_s, _LONGEST_LOOK_S)
    for context in ready:
        context.loop.call_soon_threadsafe(partial(warn_of_leftovers, context), "start")
    if on_ready is not None:
        on_ready()


def _ready_contexts(scope: Scope) -> list[Context]:
    return [
        context
        for context in tuple(scope.contexts)
        if context.loop.is_running
        and context.nodes  # in this order: it may be half made
    ]
