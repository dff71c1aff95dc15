"""The very first start: kernels are compiled in processes, and the page shows it.

One process compiles those of SLAM and exploration; a start that needs neither does not
wait for it. Later starts load the machine code. Until the simulation opens its live
view, a small server answers on the same port: the page, and ``/status.json``.
"""

import atexit
import contextlib
import importlib.resources
import json
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

from navette.errors import InvalidValueError
from navette.files.kernels import are_prepared, stored_kernels
from navette.navigation.stack.kernel_part import LATER, LOCATING, PARTS, mark_of
from navette.navigation.stack.options import RunOptions
from navette.runtime import Stopwatch
from navette.viewer.listening import listen

# What the progress calls each part.
_SUBJECTS = {"planning": "planner", "driving": "drive", LOCATING: "SLAM"}
_LOOPBACK = ("127.0.0.1", "localhost", "::1")
_PERIOD_S = 0.2
_END_S = 2.0


class Preparation:
    """Progress of the first start, as the page and the terminal show it."""

    def __init__(self, parts: Sequence[str]) -> None:
        self._parts = parts
        self._stopwatch = Stopwatch()
        self._stored = stored_kernels()
        self.kernels = 0

    def update(self, parts: Sequence[str]) -> None:
        """Count the kernels stored since the beginning; ``parts`` are unfinished."""
        self._parts = parts
        self.kernels = max(0, stored_kernels() - self._stored)

    @property
    def subjects(self) -> str:
        """Return what is being compiled: "planner and SLAM"."""
        *others, last = (_SUBJECTS[part] for part in self._parts)
        return f"{', '.join(others)} and {last}" if others else last

    @property
    def text(self) -> str:
        return (
            f"compiling kernels of {self.subjects}: "
            f"{self.kernels} done, {self.seconds:.0f} s"
        )

    @property
    def seconds(self) -> float:
        return self._stopwatch.elapsed_s

    def as_json(self) -> bytes:
        """Return the content of ``/status.json``."""
        status = {
            "state": "preparing",
            "what": f"compiling kernels of {self.subjects}, once",
            "kernels": self.kernels,
            "seconds": round(self.seconds, 1),
        }
        return json.dumps(status).encode()


def prepare(
    options: RunOptions, announce: Callable[[str], None], show: Callable[[str], None]
) -> None:
    """Compile the kernels if they are not stored yet.

    ``announce`` gets lines that stay, ``show`` the progress several times a second. A
    failure is not one of the run: the simulation compiles what is missing.
    """
    parts = [part for part in _needed(options) if not are_prepared(mark_of(part))]
    if not parts:
        return
    progress = Preparation(parts)
    with _page(options, progress) as url:
        where = f"; the live view {url} opens already" if url else ""
        announce(
            f"first start: compiling kernels of {progress.subjects}, "
            f"up to a minute, once{where}"
        )
        _compile(parts, progress, show)
        announce(f"{progress.kernels} kernels compiled in {progress.seconds:.1f} s")


def _needed(options: RunOptions) -> list[str]:
    """Return the parts whose kernels the run calls."""
    locates = options.methods.get("localization", "").startswith("slam")
    is_needed = locates or options.verb == "explore"
    return [part for part in PARTS if part != LOCATING or is_needed]


def _compile(
    parts: Sequence[str], progress: Preparation, show: Callable[[str], None]
) -> None:
    """Compile parts at once, and show the progress until all have ended."""
    with contextlib.ExitStack() as ends:
        unless_done = ends.enter_context(contextlib.ExitStack())
        for part in PARTS:
            if part not in parts and not are_prepared(mark_of(part)):
                later = _started(part, LATER)
                unless_done.callback(_end, later)
                atexit.register(_end, later)
        processes = {part: _started(part) for part in parts}
        for process in processes.values():
            ends.callback(_end, process)
        while processes:
            progress.update([*processes])
            show(progress.text)
            _wait(next(iter(processes.values())))
            processes = {
                k: each for k, each in processes.items() if each.poll() is None
            }
        unless_done.pop_all()


def _started(*part: str) -> "subprocess.Popen[bytes]":
    return subprocess.Popen(
        [sys.executable, "-m", "navette.navigation.stack.kernel_part", *part],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


def _wait(process: "subprocess.Popen[bytes]") -> None:
    """Wait until a process ends, for a while at most."""
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(_PERIOD_S)


def _end(process: "subprocess.Popen[bytes]") -> None:
    if process.poll() is None:
        process.terminate()
        process.wait(_END_S)


@contextlib.contextmanager
def _page(options: RunOptions, progress: Preparation) -> Iterator[str]:
    """Serve the page of the preparation on the live view's port, if that is local."""
    if options.headless or options.port == 0 or options.host not in _LOOPBACK:
        yield ""
        return
    try:
        listeners = listen(options.host, options.port)
    except InvalidValueError:
        yield ""  # the simulation reports it
        return
    servers = [_Server(listener, progress) for listener in listeners]
    threads = [threading.Thread(target=s.serve_forever, args=(0.05,)) for s in servers]
    for thread in threads:
        thread.start()
    try:
        yield f"http://127.0.0.1:{options.port}"
    finally:
        for server in servers:
            server.shutdown()
            server.server_close()
        for thread in threads:
            thread.join()


class _Server(ThreadingHTTPServer):
    daemon_threads = True

    def __init__(self, listener: socket.socket, progress: Preparation) -> None:
        super().__init__(listener.getsockname()[:2], _Handler, bind_and_activate=False)
        self.socket.close()
        self.socket = listener
        self.progress = progress
        page = importlib.resources.files("navette.cli").joinpath("preparing.html")
        self.page = page.read_bytes()


class _Handler(BaseHTTPRequestHandler):
    server: _Server
    timeout = 2.0

    def do_GET(self) -> None:
        """Answer with the status or, for every other path, the page."""
        if self.path.split("?")[0] == "/status.json":
            self._answer(self.server.progress.as_json(), "application/json")
        elif "upgrade" in self.headers:
            self.send_error(HTTPStatus.SERVICE_UNAVAILABLE)
        else:
            self._answer(self.server.page, "text/html; charset=utf-8")

    def _answer(self, content: bytes, kind: str) -> None:
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(content)))
        self.send_header("Cache-Control", "no-store")
        self.send_header("Connection", "close")
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, format: str, *args: object) -> None:
        """Log nothing: the terminal shows the progress."""
