"""Child process: its output, its exit, and signals to its process group."""

import contextlib
import os
import select
import signal
import subprocess
import threading
from typing import IO, Protocol

from navette.supervisor.fork_server import ForkedProcess
from navette.supervisor.guard import Guard

_POSIX = os.name == "posix"
_CHUNK_BYTES = 65536
# After its exit, the output may be held open by grandchildren: read on for this long,
# or longer while there is unread output.
_LAST_OUTPUT_S = 0.5
_DRAIN_S = 10.0
# How long the rest of the process group may take to end.
_GROUP_END_S = 2.0
_POLL_S = 0.02

INTERRUPT = int(signal.SIGINT)
TERMINATE = int(signal.SIGTERM)
KILL = int(getattr(signal, "SIGKILL", 9))


class ProcessListener(Protocol):
    """Receives output and exit of a process, from any thread."""

    def output(self, stream: str, data: bytes) -> None:
        """Handle output; ``stream`` is ``stdout`` or ``stderr``."""

    def exited(self, code: int) -> None:
        """Handle the exit, the last call; a negative code is a signal number."""


class ProcessHandle(Protocol):
    """A started process."""

    @property
    def pid(self) -> int: ...

    def watch(self, listener: ProcessListener) -> None:
        """Report output and exit to ``listener`` from now on."""

    def signal(self, number: int) -> None:
        """Send a signal to the process and its descendants; ignored after its exit."""

    def write(self, data: bytes) -> None:
        """Write to the standard input; ignored after its exit."""


class ChildProcess:
    """Process handle of a subprocess; threads read its output.

    Args:
        process: the leader of its process group.
        guard: is notified once no process of the group is left.
    """

    def __init__(
        self, process: "subprocess.Popen[bytes] | ForkedProcess", guard: Guard | None
    ) -> None:
        self._process = process
        self._guard = guard
        pipes = (("stdout", process.stdout), ("stderr", process.stderr))
        self._pipes = [(name, pipe) for name, pipe in pipes if pipe is not None]
        self._delivering: set[str] = set()

    @property
    def pid(self) -> int:
        return self._process.pid

    def watch(self, listener: ProcessListener) -> None:
        """Start the threads that report output and exit."""
        readers = [
            threading.Thread(target=self._read, args=(*pipe, listener), daemon=True)
            for pipe in self._pipes
        ]
        waiter = threading.Thread(
            target=self._wait, args=(readers, listener), daemon=True
        )
        for thread in (*readers, waiter):
            thread.start()

    def signal(self, number: int) -> None:
        if self._process.poll() is not None:
            return
        with contextlib.suppress(ProcessLookupError):  # ended meanwhile
            if self._signal_group(number):
                return
            if _POSIX:  # a fork that does not lead its group yet
                os.kill(self.pid, number)
            elif number == INTERRUPT:
                os.kill(self.pid, signal.CTRL_BREAK_EVENT)  # type: ignore[attr-defined] # Windows only
            elif isinstance(self._process, subprocess.Popen):
                self._process.terminate()

    def write(self, data: bytes) -> None:
        if self._process.stdin is not None:
            # The process may have closed its input or ended.
            with contextlib.suppress(BrokenPipeError, ValueError):
                self._process.stdin.write(data)
                self._process.stdin.flush()

    def _read(self, name: str, pipe: IO[bytes], listener: ProcessListener) -> None:
        with pipe:
            while data := os.read(pipe.fileno(), _CHUNK_BYTES):
                self._delivering.add(name)
                listener.output(name, data)
                self._delivering.discard(name)

    def _wait(self, readers: list[threading.Thread], listener: ProcessListener) -> None:
        code = self._process.wait()
        self._drain(readers)
        # Descendants left in the process group end with the process.
        has_descendants = self._signal_group(TERMINATE)
        if self._process.stdin is not None:
            with contextlib.suppress(BrokenPipeError):
                self._process.stdin.close()
        listener.exited(code)
        if has_descendants and not self._group_ends():
            self._signal_group(KILL)
        if self._guard is not None:
            self._guard.discard(self.pid)

    def _drain(self, readers: list[threading.Thread]) -> None:
        """Wait for the readers; descendants may hold the output open forever."""
        waited_s = 0.0
        while reading := [each for each in readers if each.is_alive()]:
            reading[0].join(_POLL_S)
            waited_s += _POLL_S
            limit_s = _DRAIN_S if self._has_unread() else _LAST_OUTPUT_S
            if waited_s >= limit_s:
                return

    def _has_unread(self) -> bool:
        """Return whether output waits to be read or is being delivered."""
        if self._delivering or not _POSIX:
            return bool(self._delivering)
        with contextlib.suppress(ValueError):  # closed meanwhile: all was read
            return any(select.select([pipe], [], [], 0)[0] for _, pipe in self._pipes)
        return False

    def _group_ends(self) -> bool:
        """Wait for the end of the process group; return False on timeout."""
        pause, left_s = threading.Event(), _GROUP_END_S
        while left_s > 0 and self._signal_group(0):
            pause.wait(_POLL_S)
            left_s -= _POLL_S
        return left_s > 0

    def _signal_group(self, number: int) -> bool:
        """Send a signal to the group; return whether it has any process."""
        if not _POSIX:
            return False
        try:
            os.killpg(self.pid, number)
        except (ProcessLookupError, PermissionError):
            return False
        return True
