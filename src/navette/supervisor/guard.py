"""Guard: ends child processes if this process ends before them."""

import contextlib
import logging
import os
import subprocess
import sys
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path

from navette.supervisor.guard_program import GRACE_S, VARIABLE

# -P: the script's folder is not a place to import from.
_COMMAND = [sys.executable, "-P", str(Path(__file__).parent / "guard_program.py")]
# After as many, the helper cannot run here; each start takes a tenth of a second.
_MOST_HELPERS = 10
_log = logging.getLogger(__name__)


class Guard:
    """Helper process that holds a list of process groups.

    A pipe to the helper closes when this process ends, even by SIGKILL; the helper then
    ends the listed groups. A helper that is killed is replaced, up to ten times. POSIX
    only.

    Args:
        hold: file descriptors that the helper keeps open; a lock is then held until
            the helper has finished.
        grace_s: seconds from SIGINT to SIGTERM, and from SIGTERM to SIGKILL.
    """

    def __init__(self, hold: Sequence[int] = (), grace_s: float = GRACE_S) -> None:
        self.token = f"{os.getpid()}.{os.urandom(6).hex()}"
        self._hold = tuple(hold)
        self._grace_s = grace_s
        self._groups: set[int] = set()
        self._lock = threading.Lock()
        self._closed = False
        self._started = 0
        self._process = self._start()

    @property
    def pid(self) -> int:
        return self._process.pid

    def add(self, group: int) -> None:
        """Guard a process group."""
        with self._lock:
            self._groups.add(group)
            self._send(f"+{group}")

    def discard(self, group: int) -> None:
        """Stop guarding a process group that has ended."""
        with self._lock:
            self._groups.discard(group)
            self._send(f"-{group}")

    def close(self) -> None:
        """End the remaining processes and wait for the helper."""
        with self._lock:
            self._closed = True
            process = self._process
            assert process.stdin is not None, "started with a pipe"
            with contextlib.suppress(BrokenPipeError):
                process.stdin.close()
        process.wait()

    def _start(self) -> "subprocess.Popen[bytes]":
        # The helper inherits no output: a reader of this process's output must not
        # wait for it. Without tokens: another guard must not take it for a child.
        self._started += 1
        process = subprocess.Popen(
            [*_COMMAND, self.token, str(self._grace_s)],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env=without_tokens(os.environ),
            cwd="/",
            start_new_session=True,
            pass_fds=self._hold,
        )
        threading.Thread(target=self._watch, args=(process,), daemon=True).start()
        return process

    def _watch(self, process: "subprocess.Popen[bytes]") -> None:
        code = process.wait()
        with self._lock:
            if self._closed:
                return
            assert process.stdin is not None, "started with a pipe"
            with contextlib.suppress(BrokenPipeError):
                process.stdin.close()
            if self._started == _MOST_HELPERS:
                _log.error(
                    "the helper that ends the other processes if this one is killed "
                    "has ended %d times, last with exit code %d; it is not replaced",
                    self._started,
                    code,
                )
                return
            self._process = self._start()
            for group in self._groups:
                self._send(f"+{group}")

    def _send(self, line: str) -> None:
        stdin = self._process.stdin
        assert stdin is not None, "started with a pipe"
        # If the helper was just killed, its replacement gets the whole list.
        with contextlib.suppress(BrokenPipeError, ValueError):
            stdin.write(f"{line}\n".encode())
            stdin.flush()


def end_processes_with(token: str) -> None:
    """End the processes of a guard that was killed together with its parent."""
    subprocess.run(
        [*_COMMAND, token],
        stdin=subprocess.DEVNULL,
        env=without_tokens(os.environ),
        check=False,
    )


def with_token(env: Mapping[str, str], token: str) -> dict[str, str]:
    """Return the environment of a process that this guard watches as well."""
    tokens = [each for each in env.get(VARIABLE, "").split(":") if each]
    if token not in tokens:
        tokens.append(token)
    return {**env, VARIABLE: ":".join(tokens)}


def without_tokens(env: Mapping[str, str]) -> dict[str, str]:
    """Return the environment of a process that no guard watches."""
    return {name: value for name, value in env.items() if name != VARIABLE}
