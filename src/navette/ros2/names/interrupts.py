"""Ctrl-C for a program in a thread: KeyboardInterrupt raised in it, and only in it."""

import ctypes
import sys
import threading
from collections.abc import Callable

_LOOK_S = 0.01


class ThreadInterrupt:
    """Interrupts what :meth:`run` runs; not what comes before or after.

    Args:
        wake: called after each interrupt: makes the thread stop waiting.
    """

    def __init__(self, wake: Callable[[], object]) -> None:
        self._wake = wake
        self._ident: int | None = None
        self._is_wished = False
        self._over = threading.Event()
        self._lock = threading.Lock()

    def run(self, work: Callable[[], int]) -> int | None:
        """``work()`` in this thread; None where an interrupt got out of it."""
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
                continue  # refuse, and leave

    def interrupt(self) -> None:
        """From another thread. Before the start: it is interrupted as it starts.

        Not amid an import: Python's import locks would stay taken, and whoever imports
        next would wait for ever. It comes right after.
        """
        if not self._deliver():
            threading.Thread(target=self._deliver_later, daemon=True).start()

    def _accept(self) -> None:
        with self._lock:
            self._ident = threading.get_ident()
            wished = self._is_wished
        if wished:
            raise KeyboardInterrupt

    def _refuse(self) -> None:
        """From here on none comes; one under way is taken back."""
        self._over.set()
        self._lock.acquire()  # no `with`: it could be left half entered
        self._lock.release()
        _raise_in(threading.get_ident(), None)

    def _deliver_later(self) -> None:
        pause = threading.Event()
        while not self._deliver():
            pause.wait(_LOOK_S)

    def _deliver(self) -> bool:
        """Interrupt it now; False if that has to wait."""
        if self._over.is_set():
            return True
        with self._lock:
            if self._over.is_set():
                return True
            if self._ident is None:
                self._is_wished = True
                return True
            if _is_importing(self._ident):
                return False
            _raise_in(self._ident, KeyboardInterrupt)
        self._wake()
        return True


def _raise_in(ident: int, exception: type[BaseException] | None) -> None:
    """Let a thread raise; None takes back what it has not raised yet."""
    raised = None if exception is None else ctypes.py_object(exception)
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(ident), raised)


def _is_importing(ident: int) -> bool:
    """Whether a thread is in Python's import machinery, at whatever depth."""
    frame = sys._current_frames().get(ident)
    while frame is not None:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back
    return False
