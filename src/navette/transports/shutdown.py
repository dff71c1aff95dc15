"""End of the process: no thread may be inside Zenoh when the interpreter ends.

Python kills a thread that returns to it while the interpreter ends. If the thread
returns from Zenoh, this aborts the whole process (SIGABRT, "exception not rethrown"),
so that a run whose results were saved seems to have failed. Such a thread exists while
a session closes: closing waits for links that are being opened, up to 10 s if the other
process is stopped (Ctrl-Z) or the machine is busy. The interpreter therefore waits.
"""

import atexit
import logging
import os
import sys
import threading
import weakref
from contextlib import suppress

_inside: "weakref.WeakSet[threading.Thread]" = weakref.WeakSet()


class _End:
    exit_code: int | None = None


def wait_for_at_end(thread: threading.Thread) -> None:
    """Let the end of the interpreter wait for a thread that is inside Zenoh."""
    _inside.add(thread)


def end_with(exit_code: int) -> None:
    """End the process with that code at once if a thread is still inside Zenoh.

    For commands that people type: they skip the rest of the interpreter's own end
    instead of waiting. All other programs wait.
    """
    _End.exit_code = exit_code


@atexit.register
def _wait_for_all() -> None:
    threads = [thread for thread in list(_inside) if thread.is_alive()]
    if threads and _End.exit_code is not None:
        logging.shutdown()
        for stream in (sys.stdout, sys.stderr):
            with suppress(OSError, ValueError):  # the reader has closed it
                stream.flush()
        os._exit(_End.exit_code)
    for thread in threads:
        thread.join()


# A forked child has none of its parent's threads.
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_inside.clear)
