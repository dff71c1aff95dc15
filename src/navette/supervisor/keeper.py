"""Whoever starts processes: each in a group of its own, and none outlives it."""

import os
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from navette.errors import NavetteError
from navette.supervisor.child import ChildProcess, Listener, Process
from navette.supervisor.forking import Forking, Wish
from navette.supervisor.guard import Guard, marked
from navette.supervisor.guard_program import GRACE_S, VARIABLE

_POSIX = os.name == "posix"


class ProcessError(NavetteError):
    """A process cannot be started; the text says which and why."""


@dataclass(frozen=True, kw_only=True)
class StartOptions:
    """How a process is started.

    ``env`` None means this process's own. ``shell``: the words, joined, are a line
    for the shell. ``one_stream``: what it writes to stderr comes as stdout, in order.
    ``pass_fds``: file descriptors it inherits.
    """

    cwd: str | None = None
    env: Mapping[str, str] | None = None
    shell: bool = False
    one_stream: bool = False
    pass_fds: tuple[int, ...] = ()


class Keeper:
    """Starts processes and sees to it that none outlives this one.

    Where there are process groups, each process leads one, so that a signal reaches
    all that it started; and a guard ends them if this process dies without having
    done so (SIGKILL, out of memory). On Linux it also finds what left its group.

    Args:
        hold: file descriptors that the guard keeps open until it is done.
        grace_s: what the guard gives a process to end, before it uses more force.
    """

    def __init__(self, hold: Sequence[int] = (), grace_s: float = GRACE_S) -> None:
        self._hold = tuple(hold)
        self._grace_s = grace_s
        self._guard: Guard | None = None
        self._forking: Forking | None = None

    def prepare(self) -> None:
        """Have programs of Navette start sooner, if there will be any; optional."""
        guard = self.guard()
        if guard is not None:
            self._forking_of(guard).prepare(marked(os.environ, guard.token))

    def start(
        self, words: Sequence[str], listener: Listener, options: StartOptions
    ) -> ChildProcess:
        """Start a process.

        Raises:
            ProcessError: it cannot be started.
        """
        guard = self.guard()
        env = os.environ if options.env is None else options.env
        if guard is None:
            return ChildProcess(_popen(words, options, env), listener, lambda: None)
        env = marked(env, guard.token)
        process: Process | None = None
        if not options.shell:
            process = self._forking_of(guard).start(
                Wish(words, env, options.cwd, options.one_stream, options.pass_fds)
            )
        if process is None:
            process = _popen(words, options, env)
        pid = process.pid
        guard.add(pid)
        return ChildProcess(process, listener, lambda: guard.discard(pid))

    def _forking_of(self, guard: Guard) -> Forking:
        if self._forking is None:
            self._forking = Forking(guard.add, guard.discard)
        return self._forking

    @property
    def token(self) -> str:
        """What every process it started carries; empty where there is no guard."""
        guard = self.guard()
        return "" if guard is None else guard.token

    def guard(self) -> Guard | None:
        """The guard, started if need be; None where there are no process groups."""
        if self._guard is None and _POSIX:
            self._guard = Guard(self._hold, self._grace_s)
        return self._guard

    @contextmanager
    def keeping_all(self) -> Iterator[None]:
        """Keep, too, what this process itself starts by other means (on Linux)."""
        guard = self.guard()
        before = os.environ.get(VARIABLE)
        if guard is not None:
            os.environ.update(marked(os.environ, guard.token))
        try:
            yield
        finally:
            if before is None:
                os.environ.pop(VARIABLE, None)
            else:
                os.environ[VARIABLE] = before

    def close(self) -> None:
        """End what there still is, and the guard."""
        if self._forking is not None:
            self._forking.close()
        if self._guard is not None:
            self._guard.close()
            self._guard = None
        if self._forking is not None:
            self._forking.join()
            self._forking = None


def _popen(
    words: Sequence[str], options: StartOptions, env: Mapping[str, str]
) -> "subprocess.Popen[bytes]":
    try:
        return subprocess.Popen(
            " ".join(words) if options.shell else list(words),
            shell=options.shell,
            cwd=options.cwd,
            env=dict(env),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT if options.one_stream else subprocess.PIPE,
            start_new_session=_POSIX,
            pass_fds=options.pass_fds,
            creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),
        )
    except OSError as error:
        raise ProcessError(_reason(words[0], options.cwd, error)) from error
    except ValueError as error:  # a word or a variable that no process can have
        raise ProcessError(f"cannot start {words[0]!r}: {error}") from error


def _reason(program: str, cwd: str | None, error: OSError) -> str:
    if cwd is not None and not os.path.isdir(cwd):  # noqa: PTH112 - may be any text
        return f"cannot start {program!r} in {cwd!r}: no such folder"
    return f"cannot start {program!r}: {error.strerror}"
