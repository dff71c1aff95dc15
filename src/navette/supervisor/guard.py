"""The guard of a process that keeps others: ends them if it dies before them."""

import contextlib
import os
import subprocess
import sys
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path

from navette.supervisor.guard_program import GRACE_S, VARIABLE

_PROGRAM = Path(__file__).parent / "guard_program.py"


class Guard:
    """A small process that is told of every process group.

    It notices by the end of a pipe that this process is gone, whatever killed it. One
    that is killed itself is replaced at once. Only where there are process groups.

    Args:
        hold: file descriptors it keeps open (a lock is then held until it is done).
        grace_s: seconds from SIGINT to SIGTERM, and from there to SIGKILL.
    """

    def __init__(self, hold: Sequence[int] = (), grace_s: float = GRACE_S) -> None:
        self.token = f"{os.getpid()}.{os.urandom(6).hex()}"
        self._hold = tuple(hold)
        self._grace_s = grace_s
        self._groups: set[int] = set()
        self._lock = threading.Lock()
        self._closed = False
        self._process = self._start()

    @property
    def pid(self) -> int:
        return self._process.pid

    def add(self, group: int) -> None:
        """From now on: end this group, should this process die."""
        with self._lock:
            self._groups.add(group)
            self._tell(f"+{group}")

    def discard(self, group: int) -> None:
        """It has ended."""
        with self._lock:
            self._groups.discard(group)
            self._tell(f"-{group}")

    def close(self) -> None:
        """Let it end what there still is, and wait for that."""
        with self._lock:
            self._closed = True
            process = self._process
            assert process.stdin is not None, "it was given a pipe"
            with contextlib.suppress(BrokenPipeError):
                process.stdin.close()
        process.wait()

    def _start(self) -> "subprocess.Popen[bytes]":
        # Nothing but its pipe: whoever waits for the end of this process's output
        # must not wait for the guard's; and no outer guard may take it for a child.
        process = subprocess.Popen(
            [sys.executable, "-I", "-S", str(_PROGRAM), self.token, str(self._grace_s)],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env=without_marks(os.environ),
            cwd="/",
            start_new_session=True,
            pass_fds=self._hold,
        )
        threading.Thread(target=self._watch, args=(process,), daemon=True).start()
        return process

    def _watch(self, process: "subprocess.Popen[bytes]") -> None:
        process.wait()
        with self._lock:
            if self._closed:
                return
            assert process.stdin is not None, "it was given a pipe"
            with contextlib.suppress(BrokenPipeError):
                process.stdin.close()
            self._process = self._start()
            for group in self._groups:
                self._tell(f"+{group}")

    def _tell(self, line: str) -> None:
        stdin = self._process.stdin
        assert stdin is not None, "it was given a pipe"
        # A guard that has just been killed is told by the one that takes its place.
        with contextlib.suppress(BrokenPipeError, ValueError):
            stdin.write(f"{line}\n".encode())
            stdin.flush()


def sweep(token: str) -> None:
    """End what carries a token whose guard is gone, too (on Linux)."""
    subprocess.run(
        [sys.executable, "-I", "-S", str(_PROGRAM), token],
        stdin=subprocess.DEVNULL,
        env=without_marks(os.environ),
        check=False,
    )


def marked(env: Mapping[str, str], token: str) -> dict[str, str]:
    """The environment of a process that is kept under ``token`` as well."""
    tokens = [each for each in env.get(VARIABLE, "").split(":") if each]
    if token not in tokens:
        tokens.append(token)
    return {**env, VARIABLE: ":".join(tokens)}


def without_marks(env: Mapping[str, str]) -> dict[str, str]:
    """The environment of a process that nobody keeps."""
    return {name: value for name, value in env.items() if name != VARIABLE}
