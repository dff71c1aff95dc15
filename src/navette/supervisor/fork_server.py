"""Fork server: starts ``navette`` commands without importing Navette again (Linux).

The standard library's fork server imports a module once and forks for each command.
Importing Navette costs 0.25 s of processor time, which 50 processes pay 50 times.
"""

import atexit
import os
import runpy
import signal
import sys
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.context import ForkServerProcess
from pathlib import Path
from typing import IO

_COMMAND = [sys.executable, "-u", "-m", "navette"]
# Variables that take effect at the start of Python or while libraries are loaded.
_STARTUP_VARIABLES = (
    *("PYTHON", "LD_", "LC_", "LANG", "MALLOC_", "GLIBC_"),
    *("OMP_", "OPENBLAS_", "MKL_", "BLIS_", "NPY_", "NUMPY_"),
)


class ForkedProcess:
    """Process of the fork server, with the interface of :class:`subprocess.Popen`."""

    def __init__(
        self,
        process: ForkServerProcess,
        stdin: IO[bytes],
        stdout: IO[bytes],
        stderr: IO[bytes],
    ) -> None:
        self.stdin, self.stdout, self.stderr = stdin, stdout, stderr
        self._process = process
        self._code: int | None = None

    @property
    def pid(self) -> int:
        assert self._process.pid is not None, "started"
        return self._process.pid

    def poll(self) -> int | None:
        return self._code

    def wait(self) -> int:
        """Return the exit code; for one thread only."""
        self._process.join()
        self._code = self._process.exitcode
        assert self._code is not None, "ended"
        return self._code


class ForkServer:
    """Starts ``python -u -m navette …`` commands in forks.

    The fork server of the standard library exists once per process and re-imports the
    main module in each fork. Use this class only if the main module is Navette's.
    """

    def __init__(self) -> None:
        self._context = get_context("forkserver")
        self._startup_variables = _startup_variables(os.environ)

    def accepts(self, argv: Sequence[str], env: Mapping[str, str]) -> bool:
        """Return whether a fork behaves as a new Python process would."""
        is_navette = list(argv[: len(_COMMAND)]) == _COMMAND
        return is_navette and _startup_variables(env) == self._startup_variables

    def start(self, argv: Sequence[str], env: Mapping[str, str]) -> ForkedProcess:
        """Start a command; it soon leads a process group of its own."""
        stdin, write = os.pipe()
        read, stdout = os.pipe()
        read_error, stderr = os.pipe()
        ends = [Connection(end) for end in (stdin, stdout, stderr)]
        process = self._context.Process(
            target=_run_command, args=(list(argv), dict(env), ends)
        )
        process.start()
        for connection in ends:
            connection.close()
        return ForkedProcess(
            process,
            stdin=os.fdopen(write, "wb"),
            stdout=os.fdopen(read, "rb", 0),
            stderr=os.fdopen(read_error, "rb", 0),
        )


def _startup_variables(env: Mapping[str, str]) -> dict[str, str]:
    return {name: env[name] for name in env if name.startswith(_STARTUP_VARIABLES)}


def _run_command(argv: list[str], env: dict[str, str], ends: list[Connection]) -> None:
    """Run a ``navette`` command in a fork."""
    os.setsid()
    for number, connection in enumerate(ends):
        os.dup2(connection.fileno(), number)
        connection.close()
    os.environ.clear()
    os.environ.update(env)
    time.tzset()
    sys.orig_argv[:] = argv
    sys.argv[1:] = argv[len(_COMMAND) :]
    _reseed_numpy()
    with suppress(OSError):
        Path("/proc/self/comm").write_text("navette")
    try:
        runpy.run_module("navette", run_name="__main__", alter_sys=True)
    except KeyboardInterrupt:  # as Python ends itself
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGINT)
    finally:
        # multiprocessing does not call these functions before Python 3.14.
        atexit._run_exitfuncs()


def _reseed_numpy() -> None:
    """Give the fork its own random numbers; Python's generator does so by itself."""
    loaded = sys.modules.get("numpy.random")
    if loaded is not None:
        loaded.seed()
