"""The very first start: kernels are compiled in two processes, and the page shows it.

A third process compiles those of SLAM; the start does not wait for it. Later starts
load the machine code. Until the simulation opens its live view, a small server answers
on the same port: the page, and ``/status.json``.
"""

import atexit
import contextlib
import importlib.resources
import json
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import navette
from navette.errors import InvalidValueError
from navette.files.kernels import are_prepared, note_prepared, stored_kernels
from navette.navigation.stack.options import RunOptions
from navette.runtime import Stopwatch
from navette.viewer.listening import listen

_PARTS = ("planning", "driving")
# Compiled behind these: it is not needed to drive by the simulator's pose.
_LATER = "locating"
_LOOPBACK = ("127.0.0.1", "localhost", "::1")
_PERIOD_S = 0.2
_END_S = 2.0


class Preparation:
    """Progress of the first start, as the page and the terminal show it."""

    def __init__(self) -> None:
        self._stopwatch = Stopwatch()
        self._stored = stored_kernels()
        self.kernels = 0

    def count(self) -> None:
        """Count the kernels that have been stored since the beginning."""
        self.kernels = max(0, stored_kernels() - self._stored)

    @property
    def seconds(self) -> float:
        return self._stopwatch.elapsed_s

    def as_json(self) -> bytes:
        """Return the content of ``/status.json``."""
        status = {
            "state": "preparing",
            "what": "compiling kernels, only at the very first start",
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
    if are_prepared(navette.__version__):
        return
    progress = Preparation()
    with _page(options, progress) as url:
        where = f"; the live view {url} opens already" if url else ""
        announce(f"first start: compiling kernels, up to a minute, once{where}")
        if _compile(progress, show):
            note_prepared(navette.__version__)
        announce(f"{progress.kernels} kernels compiled in {progress.seconds:.1f} s")


def _compile(progress: Preparation, show: Callable[[str], None]) -> bool:
    """Compile in two processes; return whether both succeeded."""
    with contextlib.ExitStack() as ends:
        later = _started(_LATER, "later")
        unless_done = ends.enter_context(contextlib.ExitStack())
        unless_done.callback(_end, later)
        processes = []
        for part in _PARTS:
            process = _started(part)
            ends.callback(_end, process)
            processes.append(process)
        for process in processes:
            while not _has_ended(process):
                progress.count()
                show(f"compiled {progress.kernels} kernels, {progress.seconds:.0f} s")
        unless_done.pop_all()
        atexit.register(_end, later)
        return all(process.returncode == 0 for process in processes)


def _started(*part: str) -> "subprocess.Popen[bytes]":
    return subprocess.Popen(
        [sys.executable, "-m", "navette.navigation.stack.kernel_part", *part],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


def _has_ended(process: "subprocess.Popen[bytes]") -> bool:
    """Return whether a process has ended, after a while at most."""
    try:
        process.wait(_PERIOD_S)
    except subprocess.TimeoutExpired:
        return False
    return True


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
