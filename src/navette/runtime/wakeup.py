"""Events with which other threads end a wait of the event loop."""

import os
import select
import threading
import time
import weakref
from contextlib import suppress

# Upper limit of one wait, so that an interrupt (Ctrl-C) is handled on every platform.
_LONGEST_WAIT_S = 0.25
# select() does not accept larger descriptors.
_SELECT_LIMIT = 1024


class Wakeup:
    """Event with which another thread ends a wait.

    In place of ``threading.Event``: an interrupt (Ctrl-C) between two lines of that
    leaves its lock locked, and the next use waits for ever.
    """

    __slots__ = ("__weakref__", "_unset")

    def __init__(self) -> None:
        self._unset = threading.Lock()
        self._unset.acquire()

    def set(self) -> None:
        with suppress(RuntimeError):  # it is set already
            self._unset.release()

    def clear(self) -> None:
        self._unset.acquire(blocking=False)

    @property
    def is_pending(self) -> bool:
        return not self._unset.locked()

    def wait(self, timeout_s: float | None) -> bool:
        """Return True if woken, False after ``timeout_s`` (None: no limit)."""
        deadline = None if timeout_s is None else time.perf_counter() + timeout_s
        while True:
            left_s = _LONGEST_WAIT_S
            if deadline is not None:
                left_s = min(left_s, deadline - time.perf_counter())
            if self._wait_once(max(left_s, 0.0)):
                return True
            if deadline is not None and time.perf_counter() >= deadline:
                return False

    def _wait_once(self, timeout_s: float) -> bool:
        if not self._unset.acquire(timeout=timeout_s):
            return False
        self.set()
        return True


class DescriptorWakeup(Wakeup):
    """Wakeup by a Linux event descriptor: 12 µs faster than a lock.

    The thread that writes to a descriptor releases the GIL meanwhile, so that the
    waiting thread can take it and continue. A lock is released with the GIL held: the
    waiting thread wakes, waits for the GIL, and wakes again.
    """

    __slots__ = ("_descriptor", "_is_set")

    def __init__(self) -> None:
        super().__init__()
        self._is_set = False
        self.open()
        _with_descriptors.add(self)

    def open(self) -> None:
        """Open the descriptor; again in a forked process, which must not share it."""
        self._descriptor = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)

    def __del__(self) -> None:
        descriptor = getattr(self, "_descriptor", None)
        if descriptor is not None:  # an interrupt may end __init__ before
            os.close(descriptor)

    def set(self) -> None:
        if not self._is_set:
            self._is_set = True
            os.eventfd_write(self._descriptor, 1)

    def clear(self) -> None:
        if self._is_set:  # no system call where nothing woke or waited
            self._is_set = False
            with suppress(BlockingIOError):  # another thread is about to write
                os.eventfd_read(self._descriptor)

    @property
    def is_pending(self) -> bool:
        return self._is_set

    def _wait_once(self, timeout_s: float) -> bool:
        if self._is_set:  # possibly by a call that Ctrl-C interrupted
            return True
        # poll() counts milliseconds; select() waits for the rest of a timer.
        timeout_ms = int(timeout_s * 1e3)
        if timeout_ms or self._descriptor >= _SELECT_LIMIT:
            # Not kept: an object cannot poll again from inside a signal handler.
            poll = select.poll()
            poll.register(self._descriptor, select.POLLIN)
            is_readable = bool(poll.poll(max(timeout_ms, 1)))
        else:
            is_readable = bool(select.select((self._descriptor,), (), (), timeout_s)[0])
        if is_readable:  # by a write that a clear() came before: the next one reads it
            self._is_set = True
        return is_readable


_with_descriptors: "weakref.WeakSet[DescriptorWakeup]" = weakref.WeakSet()


def new_wakeup() -> Wakeup:
    """Return the fastest event of this system."""
    return DescriptorWakeup() if hasattr(os, "eventfd") else Wakeup()


def _reopen() -> None:
    for each in list(_with_descriptors):
        os.close(each._descriptor)
        each.open()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_reopen)
