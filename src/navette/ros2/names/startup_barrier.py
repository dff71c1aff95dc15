"""Detection of the moment at which a program's nodes exist and spin.

Unused arguments are reported then. A parent process can wait for that moment: it passes
the number of a pipe in the environment, similar to systemd's ``NOTIFY_SOCKET``.
"""

import contextlib
import os
import threading
from collections.abc import Callable
from functools import partial

from navette.ros2.names.unused_arguments import warn_of_unused_arguments
from navette.runtime.context import Context, Scope

VARIABLE = "NAVETTE_READY_FD"
# The period doubles up to the limit, so that polling does not slow down many programs
# that start at the same time.
_FIRST_POLL_S, _LONGEST_POLL_S = 0.01, 0.16


class StartupBarrier:
    """Writes to the parent's pipe, if there is one, when all programs are ready.

    Args:
        programs: number of programs in this process.
    """

    def __init__(self, programs: int = 1) -> None:
        number = os.environ.pop(VARIABLE, "")
        self._pipe = int(number) if number.isdigit() else None
        self._pending = programs
        self._lock = threading.Lock()

    def program_ready(self) -> None:
        """Count one more ready program; may be called from any thread."""
        with self._lock:
            self._pending -= 1
            if self._pending or self._pipe is None:
                return
            # The parent may have ended.
            with contextlib.suppress(OSError):
                os.write(self._pipe, b"ready")
                os.close(self._pipe)


def watch_startup(
    scope: Scope,
    is_over: Callable[[], bool],
    on_ready: Callable[[], object] | None = None,
) -> None:
    """Start a thread that waits until a context of the scope has nodes and spins.

    Args:
        is_over: whether the program has ended; then the thread ends too.
        on_ready: called in that thread.
    """
    thread = threading.Thread(target=_watch, args=(scope, is_over, on_ready))
    thread.daemon = True
    thread.start()


def _watch(
    scope: Scope,
    is_over: Callable[[], bool],
    on_ready: Callable[[], object] | None,
) -> None:
    pause, poll_s = threading.Event(), _FIRST_POLL_S
    while not (ready := _ready_contexts(scope)):
        if is_over():
            return
        pause.wait(poll_s)
        poll_s = min(2 * poll_s, _LONGEST_POLL_S)
    for context in ready:
        context.loop.call_soon_threadsafe(
            partial(warn_of_unused_arguments, context), "start"
        )
    if on_ready is not None:
        on_ready()


def _ready_contexts(scope: Scope) -> list[Context]:
    return [
        context
        for context in tuple(scope.contexts)
        if context.loop.is_running
        and context.nodes  # second: a context under construction has no nodes yet
    ]
