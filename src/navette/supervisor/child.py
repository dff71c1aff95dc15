"""A process under way: its output, its end, signals to it and all that it started."""

import contextlib
import os
import select
import signal
import subprocess
import threading
from collections.abc import Callable
from typing import IO, Protocol

_POSIX = os.name == "posix"
_CHUNK = 65536
# How long the output of a process that has ended may still come (its children's); and
# how long it may take to read what it wrote itself, on a machine with much to do.
_LAST_OUTPUT_S = 0.5
_READING_S = 10.0
# How long the rest of its group may take to end, and how often that is looked at.
_GROUP_END_S = 2.0
_LOOK_S = 0.02

INTERRUPT = int(signal.SIGINT)
TERMINATE = int(signal.SIGTERM)
KILL = int(getattr(signal, "SIGKILL", 9))


class Listener(Protocol):
    """Is told what becomes of a process; from any thread."""

    def output(self, stream: str, data: bytes) -> None:
        """It wrote ``data``; ``stream`` is ``stdout`` or ``stderr``."""

    def exited(self, code: int) -> None:
        """It ended; nothing comes after this. Negative: ended by that signal."""


class Process(Protocol):
    """As much of :class:`subprocess.Popen` as is needed here."""

    @property
    def pid(self) -> int: ...
    @property
    def stdin(self) -> IO[bytes] | None: ...
    @property
    def stdout(self) -> IO[bytes] | None: ...
    @property
    def stderr(self) -> IO[bytes] | None: ...
    def poll(self) -> int | None: ...
    def wait(self) -> int: ...


class ChildProcess:
    """Made by :class:`Keeper`; threads read what it writes.

    Args:
        process: the leader of its group.
        listener: is told of output and end, from those threads.
        on_end: called once nothing of its group is left.
    """

    def __init__(
        self,
        process: Process,
        listener: Listener,
        on_end: Callable[[], None],
    ) -> None:
        self._process = process
        self._listener = listener
        self._on_end = on_end
        pipes = (("stdout", process.stdout), ("stderr", process.stderr))
        self._delivering: set[str] = set()
        self._pipes = [(name, pipe) for name, pipe in pipes if pipe is not None]
        self._readers = [
            threading.Thread(target=self._read, args=pipe, daemon=True)
            for pipe in self._pipes
        ]
        for reader in self._readers:
            reader.start()
        threading.Thread(target=self._wait, daemon=True).start()

    @property
    def pid(self) -> int:
        return self._process.pid

    def signal(self, number: int) -> None:
        """Send a signal to it and all that it started; after its end: nothing."""
        if self._process.poll() is not None:
            return
        with contextlib.suppress(ProcessLookupError):  # it ended just now
            if _POSIX:
                os.killpg(self.pid, number)
            elif number == INTERRUPT:
                os.kill(self.pid, signal.CTRL_BREAK_EVENT)  # type: ignore[attr-defined]
            elif isinstance(self._process, subprocess.Popen):
                self._process.terminate()

    def write(self, data: bytes) -> None:
        """To its standard input."""
        if self._process.stdin is not None:
            # It may have closed its input or ended; that is its own affair.
            with contextlib.suppress(BrokenPipeError, ValueError):
                self._process.stdin.write(data)
                self._process.stdin.flush()

    def _read(self, name: str, pipe: IO[bytes]) -> None:
        with pipe:
            while data := os.read(pipe.fileno(), _CHUNK):
                self._delivering.add(name)
                self._listener.output(name, data)
                self._delivering.discard(name)

    def _wait(self) -> None:
        code = self._process.wait()
        self._last_output()
        # What the process left behind in its group ends with it.
        is_alone = not self._signal_group(TERMINATE)
        if self._process.stdin is not None:
            with contextlib.suppress(BrokenPipeError):
                self._process.stdin.close()
        self._listener.exited(code)
        if not is_alone and not self._group_ends():
            self._signal_group(KILL)
        self._on_end()

    def _last_output(self) -> None:
        """Its children may hold its output open, for ever if they like."""
        waited_s = 0.0
        while reading := [each for each in self._readers if each.is_alive()]:
            reading[0].join(_LOOK_S)
            waited_s += _LOOK_S
            limit_s = _READING_S if self._has_unread() else _LAST_OUTPUT_S
            if waited_s >= limit_s:
                return

    def _has_unread(self) -> bool:
        """Whether something of its output waits to be read, or to be passed on."""
        if self._delivering or not _POSIX:
            return bool(self._delivering)
        with contextlib.suppress(ValueError):  # closed just now: all was read
            return any(select.select([pipe], [], [], 0)[0] for _, pipe in self._pipes)
        return False

    def _group_ends(self) -> bool:
        """Wait for the end of what is left of the group; False if it takes long."""
        pause, left_s = threading.Event(), _GROUP_END_S
        while left_s > 0 and self._signal_group(0):
            pause.wait(_LOOK_S)
            left_s -= _LOOK_S
        return left_s > 0

    def _signal_group(self, number: int) -> bool:
        """Whether there is anybody of it."""
        if not _POSIX:
            return False
        try:
            os.killpg(self.pid, number)
        except (ProcessLookupError, PermissionError):
            return False
        return True
