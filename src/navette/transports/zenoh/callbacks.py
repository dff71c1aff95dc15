"""Callbacks on Zenoh's threads, which keep their Python thread state.

A thread that Python has not started gets a thread state for each call, and loses it at
the end: memory is mapped and unmapped again for each sample, while the GIL is held and
the executor waits for it. Zenoh's threads live as long as the process, so that each
keeps the state of its first call.
"""

import ctypes
import threading
from collections.abc import Callable
from typing import Any

import zenoh

_thread = threading.local()


def direct(
    function: Callable[[Any], None], on_end: Callable[[], None] | None = None
) -> Any:
    """Return a handler that calls ``function`` on Zenoh's threads.

    A channel would need a Python thread for each subscription.

    Args:
        on_end: called after the last call.
    """

    def call(argument: Any) -> None:
        if not hasattr(_thread, "is_kept"):
            _keep_thread_state()
        function(argument)

    return zenoh.handlers.Callback(call, on_end, indirect=False)


def _keep_thread_state() -> None:
    """Count one more user of the thread's state, who never leaves."""
    _thread.is_kept = True
    ctypes.pythonapi.PyGILState_Ensure()
