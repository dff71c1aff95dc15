"""How a process ends: none of its threads may be inside Zenoh when Python does.

Python kills a thread that comes back to it when it is ending. One that comes back out
of Zenoh takes the whole process with it (SIGABRT, "exception not rethrown"): what was
done and saved looks as if it had failed. Such a thread is there when a session is slow
to close: it waits for links that are being opened, up to 10 s where the other end is
stopped (Ctrl-Z) or the machine is busy. So the end of Python waits for it.
"""

import atexit
import logging
import os
import sys
import threading
import weakref
from contextlib import suppress

_inside: "weakref.WeakSet[threading.Thread]" = weakref.WeakSet()


class _Ending:
    """What is known of the end."""

    exit_code: int | None = None


def wait_for_at_end(thread: threading.Thread) -> None:
    """A thread that is inside Zenoh, and comes back some time after its session."""
    _inside.add(thread)


def end_with(exit_code: int) -> None:
    """The process is about to end with this: it need not wait for anybody.

    Who says nothing waits. A command that people type does not want to: it ends at
    once, without what is left of Python's own end, if somebody would have to be waited
    for.
    """
    _Ending.exit_code = exit_code


@atexit.register
def _wait_for_all() -> None:
    threads = [thread for thread in list(_inside) if thread.is_alive()]
    if threads and _Ending.exit_code is not None:
        logging.shutdown()
        for stream in (sys.stdout, sys.stderr):
            with suppress(OSError, ValueError):  # nobody reads it any more
                stream.flush()
        os._exit(_Ending.exit_code)
    for thread in threads:
        thread.join()


# A forked child has none of its parent's threads.
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_inside.clear)
