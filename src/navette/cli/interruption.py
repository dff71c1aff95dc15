"""Stop a verb at once on Ctrl-C and SIGTERM, without a traceback.

Python raises KeyboardInterrupt at an arbitrary line: in an import, which prints a page
of traceback; inside lock bookkeeping, which can deadlock; in a finalizer, where it is
lost. Therefore a verb

- uses the default signal action while it imports, connects and disconnects, where
  nothing needs cleanup;
- records the signal while it waits, and stops after the current event;
- gets KeyboardInterrupt elsewhere, like any Python program.
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
# How long the current event may continue after Ctrl-C, for example to print megabytes.
_GRACE_PERIOD_S = 0.3


def obey_interrupts() -> None:
    """End an inherited "ignore SIGINT", with which shells start jobs of scripts."""
    if _in_main_thread() and signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.SIG_DFL)


def raise_at_interrupt() -> None:
    """Restore KeyboardInterrupt, which :func:`navette.cli.main` disables."""
    if _in_main_thread() and signal.getsignal(signal.SIGINT) is signal.SIG_DFL:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@contextmanager
def default_signal_action() -> Iterator[None]:
    """Inside, Ctrl-C and SIGTERM end the process by their default action, silently."""
    with _handling(signal.SIG_DFL):
        yield


@contextmanager
def sigterm_as_interrupt() -> Iterator[None]:
    """Inside, SIGTERM raises KeyboardInterrupt, so that files are closed cleanly."""
    if not _in_main_thread():
        yield
        return

    def interrupt(signum: int, frame: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


@contextmanager
def ending_on_signals() -> Iterator[None]:
    """Inside, both raise KeyboardInterrupt, which leaves the block as an exit code."""
    with _handling(_signals.on_signal):
        try:
            yield
        except KeyboardInterrupt:
            from click.exceptions import (
                Exit,  # later: this module is loaded first of all
            )

            raise Exit(_signals.code) from None
        finally:
            _signals.reset()


def interruptible(
    run: Callable[[Callable[[], bool]], Any], wake: Callable[[], None]
) -> None:
    """Call ``run`` with a condition that becomes true when a signal arrives.

    Args:
        run: blocking function that returns soon after the condition is true.
        wake: makes ``run`` check the condition; called from another thread.

    Raises:
        KeyboardInterrupt: a signal arrived.
    """
    _signals.wake = wake
    try:
        run(lambda: _signals.pending)
    finally:
        _signals.wake = None
    if _signals.pending:
        _signals.pending = False
        raise KeyboardInterrupt


class _PendingSignal:
    """A signal that arrived and is not handled yet."""

    def __init__(self) -> None:
        self.code: int = INTERRUPTED
        self.pending = False
        self.count = 0
        self.wake: Callable[[], None] | None = None

    def reset(self) -> None:
        self.code, self.pending = INTERRUPTED, False

    def on_signal(self, signum: int, frame: object) -> None:
        self.code = 128 + signum
        if self.wake is None or self.pending:
            self.pending = False
            raise KeyboardInterrupt
        self.pending = True
        self.count += 1
        # In another thread: this one may hold the lock that wake() takes.
        _thread.start_new_thread(self._wake_or_exit, (self.wake, self.count))

    def _wake_or_exit(self, wake: Callable[[], None], count: int) -> None:
        wake()
        threading.Event().wait(_GRACE_PERIOD_S)
        if self.pending and self.count == count:
            sys.stdout.flush()
            os._exit(self.code)


_signals = _PendingSignal()


@contextmanager
def _handling(handler: Any) -> Iterator[None]:
    """Install a handler, in the main thread only; ignored signals stay ignored."""
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
