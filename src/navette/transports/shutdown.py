"""End of the process: no thread may be inside Zenoh when the interpreter ends.

Python kills a thread that returns to it while the interpreter ends. If the thread
returns from Zenoh, this aborts the whole process (SIGABRT, "exception not rethrown"),
so that a run whose results were saved seems to have failed. Such threads are

- a thread in which a session closes: closing waits for links that are being opened, up
  to 10 s if the other process is stopped (Ctrl-Z) or the machine is busy;
- daemon threads of a program that publishes, or creates publishers, in them;
- Zenoh's threads while they deliver a sample or a change of the graph;
- a thread that collects garbage, in whatever function it is: it frees Zenoh's objects.

The interpreter therefore waits, and garbage is left to the end of the process.
"""

import atexit
import gc
import os
import sys
import threading
import weakref
from pathlib import Path
from types import FrameType

_ZENOH = str(Path(__file__).with_name("zenoh"))
# Calls on closed sessions return at once; a program may begin others for ever.
_CALLS_S = 2.0
_POLL_S = 0.001
# A thread that waits for the interpreter's lock has no frame yet, while it returns from
# Zenoh: only a pause in which it could run shows it.
_QUIET_POLLS = 10

_inside: "weakref.WeakSet[threading.Thread]" = weakref.WeakSet()
_skips_waiting = threading.Event()


def wait_for_at_end(thread: threading.Thread) -> None:
    """Let the end of the interpreter wait for a thread that is inside Zenoh."""
    _inside.add(thread)


def skip_waiting() -> None:
    """Do not wait: the process ends without the end of the interpreter."""
    _skips_waiting.set()


@atexit.register
def _wait_for_all() -> None:
    if _skips_waiting.is_set():
        return
    for thread in list(_inside):
        if thread.is_alive():
            thread.join()
    if "zenoh" not in sys.modules:
        return
    gc.disable()
    quiet = 0
    for _ in range(round(_CALLS_S / _POLL_S)):
        is_busy = _is_collecting() or any(map(_is_call, sys._current_frames().values()))
        quiet = 0 if is_busy else quiet + 1
        if quiet == _QUIET_POLLS:
            return
        _skips_waiting.wait(_POLL_S)


def _is_collecting() -> bool:
    """Return whether a thread collects garbage: a second collection does nothing."""
    before = gc.get_stats()[0]
    gc.collect(0)
    return gc.get_stats()[0] == before


def _is_call(frame: FrameType | None) -> bool:
    """Return whether a thread executes a function of the transport, or is called by it.

    Zenoh's own threads call the transport, which calls other parts of Navette.
    """
    while frame is not None:
        if frame.f_code.co_filename.startswith(_ZENOH):
            return True
        frame = frame.f_back
    return False


# A forked child has none of its parent's threads.
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_inside.clear)
