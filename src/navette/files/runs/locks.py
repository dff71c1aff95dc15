"""Locks on files, which the kernel releases when their process ends."""

import os
import sys
import threading
from pathlib import Path

if sys.platform != "win32":
    import fcntl

# Another program that looks whether the lock is taken holds it for microseconds.
_ATTEMPTS = 5
_PAUSE_S = 0.01


class FileLock:
    """Exclusive lock on a file, until :meth:`release` or the end of the process."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor

    @classmethod
    def take(cls, path: Path) -> "FileLock | None":
        """Lock a file, which is created if necessary; None if it is locked."""
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o600)
        pause = threading.Event()
        for _ in range(_ATTEMPTS):
            if try_lock(descriptor):
                return cls(descriptor)
            pause.wait(_PAUSE_S)
        os.close(descriptor)
        return None

    @property
    def is_held(self) -> bool:
        return self._descriptor >= 0

    def release(self) -> None:
        """Release the lock; a second call has no effect."""
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1


def is_locked(path: Path) -> bool:
    """Whether a process holds the lock of a file."""
    try:
        descriptor = os.open(path, os.O_RDWR | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return False
    try:
        return not try_lock(descriptor)
    finally:
        os.close(descriptor)


def try_lock(descriptor: int) -> bool:
    """Take the lock if it is free."""
    if sys.platform == "win32":
        raise OSError("file locks need Linux or macOS")
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
