"""Callbacks on Zenoh's threads, which keep their Python thread state.

A thread that Python has not started gets a thread state for each call, and loses it at
the end: memory is mapped and unmapped again for each sample, while the GIL is held and
the executor waits for it. Zenoh's threads live as long as the process, so that each
keeps the state of its first call.
"""

import ctypes
import os
import signal
import threading
from collections.abc import Callable
from functools import partial
from typing import Any

import zenoh

_thread = threading.local()
_RETURN_S = 0.01  # in which a callback returns


def direct(
    function: Callable[[Any], None], on_end: Callable[[], None] | None = None
) -> Any:
    """Return a handler that calls ``function`` on Zenoh's threads.

    A channel would need a Python thread for each subscription. What this process
    declares or sends itself arrives on the thread that does so: Ctrl-C in a call on
    the main thread, which Zenoh would print and drop, takes effect after it.

    Args:
        on_end: called after the last call.
    """

    def call(argument: Any) -> None:
        if not hasattr(_thread, "is_kept"):
            _keep_thread_state()
        try:
            function(argument)
        except KeyboardInterrupt:
            _interrupt_later()

    def end() -> None:
        try:
            if on_end is not None:
                on_end()
        except KeyboardInterrupt:
            _interrupt_later()

    return zenoh.handlers.Callback(call, on_end and end, indirect=False)


def _keep_thread_state() -> None:
    """Count one more user of the thread's state, who never leaves."""
    _thread.is_kept = True
    ctypes.pythonapi.PyGILState_Ensure()


def _interrupt_later() -> None:
    interrupt = partial(os.kill, os.getpid(), signal.SIGINT)
    threading.Timer(_RETURN_S, interrupt).start()
