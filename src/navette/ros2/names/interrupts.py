"""Ctrl-C for a program in a thread: raise KeyboardInterrupt in that thread only."""

import ctypes
import sys
import threading
from collections.abc import Callable

_POLL_S = 0.01


WakeThread = Callable[[], object]
"""Ends a wait of the thread; called after each interrupt."""


class ThreadInterrupt:
    """Interrupt of the function that :meth:`run` calls, not of code around it."""

    def __init__(self, *, wake: WakeThread) -> None:
        self._wake = wake
        self._ident: int | None = None
        self._is_requested = False
        self._over = threading.Event()
        self._lock = threading.Lock()

    def run(self, work: Callable[[], int]) -> int | None:
        """Call ``work`` in this thread; return None if an interrupt ended it."""
        result, has_begun = None, False
        while True:
            try:
                if not has_begun:
                    has_begun = True
                    self._accept()
                    result = work()
                self._refuse()
                return result
            except KeyboardInterrupt:
                continue  # refuse further interrupts and return

    def interrupt(self) -> None:
        """Interrupt the thread, from another one; before :meth:`run`, at its start.

        An import in progress is completed first: otherwise Python's import locks would
        remain held, and every later import would block.
        """
        if not self._deliver():
            threading.Thread(target=self._deliver_later, daemon=True).start()

    def _accept(self) -> None:
        with self._lock:
            self._ident = threading.get_ident()
            requested = self._is_requested
        if requested:
            raise KeyboardInterrupt

    def _refuse(self) -> None:
        """Refuse further interrupts and withdraw a pending one."""
        self._over.set()
        # Without `with`, which an interrupt could leave after half of its entry.
        self._lock.acquire()
        self._lock.release()
        _raise_in(threading.get_ident(), None)

    def _deliver_later(self) -> None:
        pause = threading.Event()
        while not self._deliver():
            pause.wait(_POLL_S)

    def _deliver(self) -> bool:
        """Interrupt now; return False if the thread imports a module."""
        if self._over.is_set():
            return True
        with self._lock:
            if self._over.is_set():
                return True
            if self._ident is None:
                self._is_requested = True
                return True
            if _is_importing(self._ident):
                return False
            _raise_in(self._ident, KeyboardInterrupt)
        self._wake()
        return True


def _raise_in(ident: int, exception: type[BaseException] | None) -> None:
    """Raise an exception in a thread; None withdraws a pending one."""
    raised = None if exception is None else ctypes.py_object(exception)
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(ident), raised)


def _is_importing(ident: int) -> bool:
    """Whether any frame of a thread belongs to Python's import machinery."""
    frame = sys._current_frames().get(ident)
    while frame is not None:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back
    return False
