"""Commands as processes, each in a group of its own; none outlives the launch."""

import contextlib
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import IO

from navette.launch_files.launch.errors import LaunchError
from navette.launch_files.launch.running import Command, Listener, PythonProgram

_POSIX = os.name == "posix"
_GUARD = Path(__file__).parent / "process_guard.py"
_CHUNK = 65536
# How long the output of a process that has ended may still come (its children's).
_LAST_OUTPUT_S = 1.0


class SubprocessRunner:
    """Starts processes.

    Where there are process groups, each command leads one, so that a signal reaches
    all that it started; and a small guard process, told of every group, ends them
    when this process dies without having done so (SIGKILL, power of the debugger).
    """

    def __init__(self) -> None:
        self._guard: subprocess.Popen[bytes] | None = None

    def start(self, command: Command, listener: Listener) -> "RunningProcess":
        if _POSIX and self._guard is None:
            self._guard = _start_guard()
        try:
            process = self._popen(command)
        except OSError as error:
            raise LaunchError(
                f"{command.label}: cannot start {command.argv[0]!r}: {error.strerror}"
            ) from error
        self._tell_guard("+", process.pid)
        return RunningProcess(
            process, listener, lambda: self._tell_guard("-", process.pid)
        )

    def close(self) -> None:
        """Let the guard go; what it still knows of, it ends."""
        if self._guard is not None and self._guard.stdin is not None:
            self._guard.stdin.close()
            self._guard.wait()
            self._guard = None

    @staticmethod
    def _popen(command: Command) -> subprocess.Popen[bytes]:
        words = command.words
        if command.program is not None:
            inside = program_words(command.program)
            words = [*command.prefix, *inside, *command.argv[1:]]
        return subprocess.Popen(
            " ".join(words) if command.shell else words,
            shell=command.shell,
            cwd=command.cwd,
            env=None if command.env is None else dict(command.env),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=_POSIX,
            creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),
        )

    def _tell_guard(self, word: str, pid: int) -> None:
        if self._guard is not None and self._guard.stdin is not None:
            # A guard that was killed cannot guard; the launch itself goes on.
            with contextlib.suppress(BrokenPipeError, ValueError):
                self._guard.stdin.write(f"{word}{pid}\n".encode())
                self._guard.stdin.flush()


def program_words(program: PythonProgram) -> list[str]:
    """The command line that runs a Python program in a process of its own.

    ``navette run`` gives it ROS 2's module names.
    """
    search = [str(folder) for folder in program.search]
    code = (
        f"import sys; sys.path[:0] = {search!r}; from navette.cli import main; main()"
    )
    target = (
        str(program.file)
        if program.file is not None
        else f"{program.module}:{program.function}"
    )
    # -u: what a program prints is seen when it prints it.
    return [sys.executable, "-u", "-c", code, "run", target]


def _start_guard() -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        [sys.executable, "-I", "-S", str(_GUARD)],
        stdin=subprocess.PIPE,
        start_new_session=True,
    )


class RunningProcess:
    """A process under way; two threads read what it writes.

    Args:
        process: the leader of its group.
        listener: is told of output and end, from those threads.
        on_end: called once it has been waited for.
    """

    def __init__(
        self, process: "subprocess.Popen[bytes]", listener: Listener, on_end: object
    ) -> None:
        self._process = process
        self._listener = listener
        self._on_end = on_end
        self._readers = [
            threading.Thread(target=self._read, args=(name, pipe), daemon=True)
            for name, pipe in (("stdout", process.stdout), ("stderr", process.stderr))
        ]
        for reader in self._readers:
            reader.start()
        threading.Thread(target=self._wait, daemon=True).start()

    @property
    def pid(self) -> int:
        return self._process.pid

    def signal(self, number: int) -> None:
        if self._process.poll() is not None:
            return
        with contextlib.suppress(ProcessLookupError):  # it ended just now
            if _POSIX:
                os.killpg(self.pid, number)
            elif number == signal.SIGINT:
                self._process.send_signal(signal.CTRL_BREAK_EVENT)  # type: ignore[attr-defined]
            else:
                self._process.terminate()

    def write(self, data: bytes) -> None:
        if self._process.stdin is not None:
            # It may have closed its input or ended; that is its own affair.
            with contextlib.suppress(BrokenPipeError, ValueError):
                self._process.stdin.write(data)
                self._process.stdin.flush()

    def _read(self, name: str, pipe: IO[bytes]) -> None:
        while data := os.read(pipe.fileno(), _CHUNK):
            self._listener.output(name, data)

    def _wait(self) -> None:
        code = self._process.wait()
        for reader in self._readers:
            reader.join(_LAST_OUTPUT_S)
        if callable(self._on_end):
            self._end_group()
            self._on_end()
        for pipe in (self._process.stdin, self._process.stdout, self._process.stderr):
            if pipe is not None and not any(r.is_alive() for r in self._readers):
                with contextlib.suppress(BrokenPipeError):
                    pipe.close()
        self._listener.exited(code)

    def _end_group(self) -> None:
        """What the process left behind in its group ends with it."""
        if _POSIX:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(self.pid, signal.SIGTERM)
