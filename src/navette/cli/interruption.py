"""Ctrl-C and SIGTERM end a verb at once, without a traceback.

Python turns Ctrl-C into an exception at whatever line runs: in an import, where it is
a page of traceback; in a lock's bookkeeping, where the next who wants that lock waits
for ever; in a finaliser, where it is lost. So a verb

- simply dies of it while it loads, joins and leaves: there is nothing to clean up;
- takes note of it while it waits, and ends when the event under way is over;
- sees KeyboardInterrupt elsewhere, as every Python program does.
"""

import _thread
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

INTERRUPTED = 128 + signal.SIGINT

_SIGNALS = (signal.SIGINT, signal.SIGTERM)
# How long an event may go on after Ctrl-C: a message of megabytes is being printed.
_PATIENCE_S = 0.3


def raise_at_interrupt() -> None:
    """Let Ctrl-C be KeyboardInterrupt again after :func:`navette.cli.main`."""
    if _in_main_thread() and signal.getsignal(signal.SIGINT) is signal.SIG_DFL:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@contextmanager
def dying_on_signals() -> Iterator[None]:
    """Inside, Ctrl-C and SIGTERM end the process as the system does it, silently."""
    with _handling(signal.SIG_DFL):
        yield


@contextmanager
def ending_on_signals() -> Iterator[None]:
    """Inside, they raise KeyboardInterrupt; what comes out is their exit code."""
    with _handling(_asked.on_signal):
        try:
            yield
        except KeyboardInterrupt:
            from typer import Exit  # later: this module is loaded first of all

            raise Exit(_asked.code) from None
        finally:
            _asked.forget()


def interruptible(
    run: Callable[[Callable[[], bool]], Any], wake: Callable[[], None]
) -> None:
    """Call ``run`` with a condition that holds once a signal came.

    Args:
        run: waits; is to come back soon when the condition holds.
        wake: makes it look at the condition; called from another thread.

    Raises:
        KeyboardInterrupt: a signal came.
    """
    _asked.wake = wake
    try:
        run(lambda: _asked.pending)
    finally:
        _asked.wake = None
    if _asked.pending:
        _asked.pending = False
        raise KeyboardInterrupt


class _Asked:
    """Whether a signal came that nobody has seen yet."""

    def __init__(self) -> None:
        self.code: int = INTERRUPTED
        self.pending = False
        self.count = 0
        self.wake: Callable[[], None] | None = None

    def forget(self) -> None:
        self.code, self.pending = INTERRUPTED, False

    def on_signal(self, signum: int, frame: object) -> None:
        self.code = 128 + signum
        if self.wake is None or self.pending:
            self.pending = False
            raise KeyboardInterrupt
        self.pending = True
        self.count += 1
        # Not here: this thread may hold the very lock that waking it takes.
        _thread.start_new_thread(self._insist, (self.wake, self.count))

    def _insist(self, wake: Callable[[], None], count: int) -> None:
        wake()
        threading.Event().wait(_PATIENCE_S)
        if self.pending and self.count == count:
            sys.stdout.flush()
            os._exit(self.code)


_asked = _Asked()


@contextmanager
def _handling(handler: Any) -> Iterator[None]:
    """Only a main thread can; a signal that is ignored stays so."""
    if not _in_main_thread():
        yield
        return
    before = {each: signal.getsignal(each) for each in _SIGNALS}
    for each, old in before.items():
        if old is not signal.SIG_IGN:
            signal.signal(each, handler)
    try:
        yield
    finally:
        for each, old in before.items():
            signal.signal(each, old)


def _in_main_thread() -> bool:
    return threading.current_thread() is threading.main_thread()
