"""Process manager: starts processes, none of which outlives this one."""

import os
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from navette.errors import NavetteError
from navette.supervisor.child import ChildProcess
from navette.supervisor.fork_server import ForkedProcess, ForkServer
from navette.supervisor.guard import Guard, with_token
from navette.supervisor.guard_program import GRACE_S, VARIABLE

_POSIX = os.name == "posix"


class ProcessError(NavetteError):
    """A process cannot be started."""


@dataclass(frozen=True, kw_only=True)
class StartOptions:
    """How a process is started.

    Attributes:
        env: its whole environment; None: that of this process.
        shell: run the words, joined, as a line of the shell.
        merge_streams: report the standard error as standard output, in order.
        pass_fds: file descriptors that the process inherits.
    """

    cwd: str | None = None
    env: Mapping[str, str] | None = None
    shell: bool = False
    merge_streams: bool = False
    pass_fds: tuple[int, ...] = ()


class ProcessManager:
    """Starts processes in groups of their own, watched by a guard.

    A signal to a process reaches the whole group. The guard ends the groups if this
    process ends without doing so (SIGKILL, out of memory), and also descendants that
    left their group. Windows has neither groups nor the guard.

    Args:
        fork_server: starts ``navette`` commands where no option prevents that.
        hold: file descriptors that the guard keeps open until it has finished.
        grace_s: how long the guard waits before it sends a stronger signal.
    """

    def __init__(
        self,
        fork_server: ForkServer | None = None,
        *,
        hold: Sequence[int] = (),
        grace_s: float = GRACE_S,
    ) -> None:
        self._fork_server = fork_server
        self._hold = tuple(hold)
        self._grace_s = grace_s
        self._guard: Guard | None = None

    def start(self, argv: Sequence[str], options: StartOptions) -> ChildProcess:
        """Start a process.

        Raises:
            ProcessError: it cannot be started.
        """
        guard = self.guard()
        env = os.environ if options.env is None else options.env
        if guard is None:
            return ChildProcess(_popen(argv, options, env), None)
        env = with_token(env, guard.token)
        forks, plain = self._fork_server, StartOptions(env=options.env)
        process: subprocess.Popen[bytes] | ForkedProcess
        if forks is not None and options == plain and forks.accepts(argv, env):
            process = forks.start(argv, env)
        else:
            process = _popen(argv, options, env)
        guard.add(process.pid)
        return ChildProcess(process, guard)

    def guard(self) -> Guard | None:
        """Return the guard, started on first use; None without process groups."""
        if self._guard is None and _POSIX:
            self._guard = Guard(self._hold, self._grace_s)
        return self._guard

    @contextmanager
    def adopt_children(self) -> Iterator[None]:
        """Guard the processes that other code of this process starts meanwhile."""
        guard = self.guard()
        before = os.environ.get(VARIABLE)
        if guard is not None:
            os.environ.update(with_token(os.environ, guard.token))
        try:
            yield
        finally:
            if before is None:
                os.environ.pop(VARIABLE, None)
            else:
                os.environ[VARIABLE] = before

    def close(self) -> None:
        """End the remaining processes and the guard."""
        if self._guard is not None:
            self._guard.close()
            self._guard = None


def _popen(
    argv: Sequence[str], options: StartOptions, env: Mapping[str, str]
) -> "subprocess.Popen[bytes]":
    try:
        return subprocess.Popen(
            " ".join(argv) if options.shell else list(argv),
            shell=options.shell,
            cwd=options.cwd,
            env=dict(env),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT if options.merge_streams else subprocess.PIPE,
            start_new_session=_POSIX,
            pass_fds=options.pass_fds,
            creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),
        )
    except OSError as error:
        raise ProcessError(_reason(argv[0], options.cwd, error)) from error
    except ValueError as error:  # such as a null byte in a word
        raise ProcessError(f"cannot start {argv[0]!r}: {error}") from error


def _reason(program: str, cwd: str | None, error: OSError) -> str:
    if cwd is not None and not os.path.isdir(cwd):  # noqa: PTH112 - may be any text
        return f"cannot start {program!r} in {cwd!r}: no such folder"
    return f"cannot start {program!r}: {error.strerror}"
