"""End of a command's process, which does not wait for threads in native code.

When the interpreter ends, Python kills the threads that return to it. A thread that
returns from a library in C++ or Rust (Zenoh, MuJoCo) then aborts the whole process
("FATAL: exception not rethrown"), so that a run whose results were saved seems to have
failed. A command therefore ends itself after all exit functions, in place of the
interpreter.
"""

import atexit
import logging
import os
import sys
import threading
from contextlib import suppress

_exit_codes: list[int] = []


def register() -> None:
    """End the process in the last exit function: the one that is registered first."""
    atexit.register(_end)


def end_with(exit_code: object) -> None:
    """Set the exit code of the command; until then the interpreter ends the process."""
    if isinstance(exit_code, int | None):
        _exit_codes.append(exit_code or 0)
        shutdown = sys.modules.get("navette.transports.shutdown")
        if shutdown is not None:
            shutdown.skip_waiting()


def _end() -> None:
    has_threads = threading.active_count() > 1 or "zenoh" in sys.modules
    if not _exit_codes or not has_threads:
        return
    logging.shutdown()
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):  # the reader has closed it
            stream.flush()
    os._exit(_exit_codes[-1])
