"""A process that has imported Navette already and splits into programs (Linux).

``python -m navette.cli.zygote ROOM``, with a Unix socket as standard input. Each
request on it is a program of ``python -u -m navette …``: the zygote forks, and the
child takes over its words, environment, folder and file descriptors, and runs. The
zygote has one thread and no session with the network, else it could not be forked; it
tells who ended, and how. It goes when it is asked to (end of the socket, SIGINT,
SIGTERM) and its last child has ended.
"""

import contextlib
import ctypes
import fcntl
import gc
import importlib
import json
import os
import runpy
import select
import signal
import socket
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from navette.supervisor.forking import MODULE, MOST_FDS

_SIGNALS = {signal.SIGINT, signal.SIGTERM, signal.SIGCHLD}
# Where in /proc/<pid>/stat, behind the name, the place of the command line is told.
_WORDS_START, _WORDS_END = 45, 46


@dataclass(frozen=True)
class Request:
    """A program to become; ``fds`` are those it has, ``numbers`` those it wants."""

    words: list[str]
    env: dict[str, str]
    cwd: str
    fds: list[int]
    numbers: list[int]


def main() -> None:
    """Split off programs, until told to go; in a child: be that program."""
    if not sys.flags.safe_path:
        del sys.path[0]  # the folder in which it was started is not a program's
    with socket.socket(fileno=os.dup(0)) as control:
        request = Zygote(control).serve()
        if request is not None:
            become(request)
            tell(control, {"started": os.getpid()})
    if request is not None:
        runpy.run_module(MODULE, run_name="__main__", alter_sys=True)


class Zygote:
    """The loop: requests in, ends out.

    Args:
        control: where requests come from and answers go.
    """

    def __init__(self, control: socket.socket) -> None:
        self._control = control
        self._wakes, self._wake = os.pipe2(os.O_CLOEXEC | os.O_NONBLOCK)
        self._leaving = self._deaf = False
        self._alive: set[int] = set()
        signal.set_wakeup_fd(self._wake)
        signal.signal(signal.SIGCHLD, lambda *_: None)
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._leave)
        show_as([sys.executable, "-m", "navette.cli.zygote"])
        self._times = _file_times()
        gc.collect()
        gc.freeze()  # children share what they never write to

    def serve(self) -> Request | None:
        """What this process is to become, in a child; None at the end."""
        while self._alive or not self._leaving:
            wakes, control = self._wakes, self._control.fileno()
            asked = [wakes] if self._deaf else [wakes, control]
            ready, _, _ = select.select(asked, [], [])
            if wakes in ready:
                self._reap()
            if control in ready:
                request = self._receive()
                if request is not None and self._split(request):
                    return request
        return None

    def _leave(self, *_: object) -> None:
        self._leaving = True

    def _receive(self) -> Request | None:
        header, fds, _, _ = socket.recv_fds(self._control, 4, MOST_FDS)
        if not header:
            self._leaving = self._deaf = True
            return None
        size = int.from_bytes(header, "big")
        text = self._control.recv(size, socket.MSG_WAITALL)
        asked = json.loads(text)
        return Request(
            asked["words"], asked["env"], asked["cwd"], fds, asked["numbers"]
        )

    def _split(self, request: Request) -> bool:
        """Whether this is the child."""
        is_child = False
        if self._leaving or _file_times(self._times) != self._times:
            tell(self._control, {"started": None})
        else:
            # A signal that comes between is the child's, by the child's own handlers.
            signal.pthread_sigmask(signal.SIG_BLOCK, _SIGNALS)
            pid = os.fork()
            is_child = pid == 0
            self._alive.add(pid)
        if is_child:
            signal.set_wakeup_fd(-1)
            os.close(self._wakes)
            os.close(self._wake)
            return True
        signal.pthread_sigmask(signal.SIG_UNBLOCK, _SIGNALS)
        for fd in request.fds:
            os.close(fd)
        return False

    def _reap(self) -> None:
        with contextlib.suppress(BlockingIOError):
            os.read(self._wakes, 4096)
        while self._alive:
            pid, status = os.waitpid(-1, os.WNOHANG)
            if pid == 0:
                return
            self._alive.discard(pid)
            code = os.waitstatus_to_exitcode(status)
            tell(self._control, {"ended": pid, "code": code})


def tell(control: socket.socket, answer: dict[str, Any]) -> None:
    """A line to whoever asks; it may be gone: the guard sees to the children then."""
    with contextlib.suppress(BrokenPipeError, ConnectionResetError):
        control.sendall(json.dumps(answer).encode() + b"\n")


def become(request: Request) -> None:
    """Take over what makes a process that program, not this one."""
    os.setsid()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, _SIGNALS)
    _take_descriptors(request.fds, request.numbers)
    os.environ.clear()
    os.environ.update(request.env)
    time.tzset()
    os.chdir(request.cwd)
    if not sys.flags.safe_path:
        sys.path.insert(0, str(Path.cwd()))
    sys.argv[1:] = request.words[4:]
    sys.orig_argv[:] = request.words
    importlib.invalidate_caches()
    _shuffle()
    show_as(request.words)


def _take_descriptors(fds: list[int], numbers: list[int]) -> None:
    """Move the descriptors to their numbers, however the two lists overlap."""
    above = max(*fds, *numbers) + 1
    lifted = [fcntl.fcntl(fd, fcntl.F_DUPFD_CLOEXEC, above) for fd in fds]
    for fd in fds:
        os.close(fd)
    for fd, number in zip(lifted, numbers, strict=True):
        os.dup2(fd, number, inheritable=True)
        os.close(fd)


def _shuffle() -> None:
    """Python's own generator does so by itself; numpy's does not."""
    loaded = sys.modules.get("numpy.random")
    if loaded is not None:
        loaded.seed()


def show_as(words: list[str]) -> None:
    """Let ``ps`` show these words, as far as this process's own had room for them."""
    fields = Path("/proc/self/stat").read_text().rpartition(")")[2].split()
    start, end = int(fields[_WORDS_START]), int(fields[_WORDS_END])
    text = b"".join(os.fsencode(word) + b"\0" for word in words)
    if start and end - start > 1:
        # The last byte stays 0: another one would make it a single word.
        text = text[: end - start - 1]
        ctypes.memset(start, 0, end - start)
        ctypes.memmove(start, text, len(text))


def _file_times(wanted: dict[str, int] | None = None) -> dict[str, int]:
    """When what was imported, and where it is looked for, last changed, in ns.

    Args:
        wanted: the files; by default those of all modules, and the folders.
    """
    if wanted is None:
        modules = (getattr(each, "__file__", None) for each in sys.modules.values())
        paths = {*(path for path in modules if path), *sys.path}
    else:
        paths = {*wanted}
    times = {}
    for path in paths:
        try:
            times[path] = os.stat(path).st_mtime_ns  # noqa: PTH116 - for each start
        except OSError:
            times[path] = 0
    return times
