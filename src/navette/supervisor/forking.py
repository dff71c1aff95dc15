"""Programs of Navette as children of a zygote: quick to start, else like any other."""

import contextlib
import json
import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue
from typing import IO

MODULE = "navette"
MOST_FDS = 64
SWITCH = "NAVETTE_ZYGOTE"
"""``0`` in a program's environment: it starts as a Python of its own."""

_HEAD = (sys.executable, "-u", "-m", MODULE)
# The zygote's command line is as long as any that its children are to show.
_ROOM = "-" * 8192
# Read when Python starts or a library is loaded: for the zygote's children it is late.
_EARLY = (
    *("PYTHON", "LD_", "LC_", "LANG", "MALLOC_", "GLIBC_"),
    *("OMP_", "OPENBLAS_", "MKL_", "BLIS_", "NPY_", "NUMPY_"),
)


class ForkedProcess:
    """As :class:`subprocess.Popen`, for a child of the zygote."""

    def __init__(self, pid: int, streams: Sequence[IO[bytes] | None]) -> None:
        self.pid = pid
        self.stdin, self.stdout, self.stderr = streams
        self._code: int | None = None
        self._over = threading.Event()

    def end(self, code: int) -> None:
        """It has ended; negative: by that signal."""
        self._code = code
        self._over.set()

    def poll(self) -> int | None:
        """The exit code; None while it runs."""
        return self._code

    def wait(self) -> int:
        """The exit code, once there is one."""
        self._over.wait()
        assert self._code is not None, "it was set before"
        return self._code


@dataclass(frozen=True)
class Wish:
    """A program to start. ``env`` is all that it finds; ``cwd`` None: here."""

    words: Sequence[str]
    env: Mapping[str, str]
    cwd: str | None
    one_stream: bool
    pass_fds: Sequence[int]

    @property
    def is_for_zygote(self) -> bool:
        """Whether a zygote's child is the same as a Python of its own.

        What cannot be started at all is not: the ordinary way says why.
        """
        texts = (*self.words, *self.env.keys(), *self.env.values())
        folders = self.env.get("PYTHONPATH", os.sep).split(os.pathsep)
        return (
            sys.platform == "linux"
            and self.env.get(SWITCH) != "0"
            and tuple(self.words[: len(_HEAD)]) == _HEAD
            and len(self.pass_fds) + 3 <= MOST_FDS
            and len(" ".join(self.words).encode(errors="replace")) < len(_ROOM)
            and not any("\0" in text for text in texts)
            and all(map(os.path.isabs, folders))
            and (self.cwd is None or os.access(self.cwd, os.X_OK))
        )


class Forking:
    """Starts programs through a zygote, and a zygote for the first of them.

    Args:
        keep: told the process group of each zygote.
        let_go: told when it has ended.
    """

    def __init__(
        self, keep: Callable[[int], None], let_go: Callable[[int], None]
    ) -> None:
        self._keep = keep
        self._let_go = let_go
        self._links: list[_Link] = []  # the last one is in use
        self._is_broken = False
        self._lock = threading.Lock()

    def prepare(self, env: Mapping[str, str]) -> None:
        """Start a zygote already; it is ready when it is. Twice is harmless."""
        if Wish(_HEAD, env, None, False, ()).is_for_zygote:
            with self._lock:
                if not self._links:
                    self._open(env)

    def start(self, wish: Wish) -> ForkedProcess | None:
        """The program as a process; None where it is to start the ordinary way."""
        if not wish.is_for_zygote:
            return None
        with self._lock:
            # A second zygote where files have changed since the first.
            for _ in range(2):
                link = self._links[-1] if self._links else self._open(wish.env)
                if self._is_broken or link.early != _early(wish.env):
                    return None
                found = link.start(wish)
                if found is not None:
                    return found
                link.close()
                self._open(wish.env)
            self._is_broken = True
        return None

    def close(self) -> None:
        """Each zygote goes when its last child has."""
        with self._lock:
            for link in self._links:
                link.close()

    def join(self) -> None:
        """Wait until they have gone."""
        for link in self._links:
            link.thread.join()

    def _open(self, env: Mapping[str, str]) -> "_Link":
        self._links = [each for each in self._links if each.thread.is_alive()]
        link = _Link(env, self._let_go)
        self._keep(link.pid)
        self._links.append(link)
        return link


class _Link:
    """A zygote and the connection to it.

    Args:
        let_go: called with its process id when it has ended.
    """

    def __init__(self, env: Mapping[str, str], let_go: Callable[[int], None]) -> None:
        self.early = _early(env)
        self._let_go = let_go
        self._control, there = socket.socketpair()
        with there:
            # Pipes that nobody reads: Python's streams are then made for pipes.
            self._process: subprocess.Popen[bytes] = subprocess.Popen(
                [*_HEAD[:3], "navette.cli.zygote", _ROOM],
                env=dict(env),
                cwd="/",
                stdin=there.fileno(),
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                start_new_session=True,
            )
        for pipe in (self._process.stdout, self._process.stderr):
            assert pipe is not None, "it was given a pipe"
            pipe.close()
        self._streams: list[IO[bytes] | None] = []
        self._started: SimpleQueue[ForkedProcess | None] = SimpleQueue()
        self._children: dict[int, ForkedProcess] = {}
        self.thread = threading.Thread(target=self._listen, daemon=True)
        self.thread.start()

    @property
    def pid(self) -> int:
        return self._process.pid

    def start(self, wish: Wish) -> ForkedProcess | None:
        """None if this zygote is of no use any more."""
        self._streams, theirs = _pipes(one_stream=wish.one_stream)
        said = {
            "words": list(wish.words),
            "env": dict(wish.env),
            "cwd": wish.cwd or str(Path.cwd()),
            "numbers": [0, 1, 2, *wish.pass_fds],
        }
        text = json.dumps(said).encode()
        try:
            header = len(text).to_bytes(4, "big")
            socket.send_fds(self._control, [header], [*theirs, *wish.pass_fds])
            self._control.sendall(text)
            child = self._started.get()
        except OSError:  # it is gone
            child = None
        for fd in {*theirs}:
            os.close(fd)
        if child is None:
            for stream in self._streams:
                if stream is not None:
                    stream.close()
        return child

    def close(self) -> None:
        """Ask nothing more of it."""
        with contextlib.suppress(OSError):
            self._control.shutdown(socket.SHUT_WR)

    def _listen(self) -> None:
        # Reset: it has died before it read a request.
        reset = contextlib.suppress(ConnectionResetError)
        with self._control.makefile("rb") as lines, reset:
            for line in lines:
                told = json.loads(line)
                if "ended" in told:
                    self._ended(told["ended"], told["code"])
                else:
                    self._began(told["started"])
        self._control.close()
        self._process.wait()
        self._let_go(self.pid)
        self._started.put(None)
        for child in self._children.values():
            # It was killed; who it left can be waited for by nobody.
            with contextlib.suppress(ProcessLookupError):
                os.killpg(child.pid, signal.SIGKILL)
            child.end(-signal.SIGKILL)

    def _began(self, pid: int | None) -> None:
        child = None if pid is None else ForkedProcess(pid, self._streams)
        if child is not None:
            self._children[child.pid] = child
        self._started.put(child)

    def _ended(self, pid: int, code: int) -> None:
        child = self._children.pop(pid, None)
        if child is None:  # before it was a program
            self._started.put(None)
        else:
            child.end(code)


def _pipes(*, one_stream: bool) -> tuple[list[IO[bytes] | None], list[int]]:
    """Streams for here; descriptors of standard input, output and errors for there."""
    read, write = os.pipe()
    mine: list[IO[bytes] | None] = [os.fdopen(write, "wb")]
    theirs = [read]
    for _ in range(1 if one_stream else 2):
        read, write = os.pipe()
        mine.append(os.fdopen(read, "rb", 0))
        theirs.append(write)
    if one_stream:
        mine.append(None)
        theirs.append(theirs[1])
    return mine, theirs


def _early(env: Mapping[str, str]) -> dict[str, str]:
    return {name: env[name] for name in env if name.startswith(_EARLY)}
