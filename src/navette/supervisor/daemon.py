"""Supervisor process: one per project, detached from the command that started it.

Started as ``python -m navette.supervisor.daemon FOLDER SOCKET READY_FD``. It exits when
no service is left; all its processes end with it, whatever ends it.
"""

import json
import os
import queue
import signal
import sys
import threading
from pathlib import Path
from typing import Any

from navette.files.runs.locks import try_lock
from navette.runtime import SystemClock
from navette.runtime.events import Call
from navette.runtime.loop import EventLoop
from navette.supervisor.client import accepts_connections
from navette.supervisor.guard import end_processes_with
from navette.supervisor.log_store import LogStore
from navette.supervisor.process_manager import ProcessManager
from navette.supervisor.project import (
    INFO_NAME,
    Project,
    create_state,
    lock_path,
    read_info,
)
from navette.supervisor.server import RequestServer
from navette.supervisor.service_config import ServiceConfig
from navette.supervisor.supervisor import Supervisor

# The guard of a killed supervisor holds the lock until it has ended all processes.
_LOCK_TIMEOUT_S = 15.0
_POLL_S = 0.05
# An idle supervisor stays this long: after "down", the client requests the status.
_LINGER_S = 0.5


def main(folder: Path, socket: Path, ready: int) -> None:
    """Supervise the project of a folder until no service is left."""
    state = create_state(Project(folder))
    lock = os.open(lock_path(state), os.O_RDWR | os.O_CREAT, 0o600)
    if not _locked(lock, socket):
        os.write(ready, b"taken")  # another supervisor was faster
        return
    try:
        daemon = _Daemon(folder, socket, lock)
    except OSError as error:  # for example a full disk
        os.write(ready, str(error).encode())
        return
    os.write(ready, b"ready")
    os.close(ready)
    daemon.run()


def _locked(lock: int, socket: Path) -> bool:
    """Take the lock; return False if another supervisor runs, or on timeout."""
    pause, left_s = threading.Event(), _LOCK_TIMEOUT_S
    while not try_lock(lock):
        if accepts_connections(socket) or left_s <= 0:
            return False
        pause.wait(_POLL_S)
        left_s -= _POLL_S
    return True


class _Daemon:
    """Supervisor with its loop, log and socket."""

    def __init__(self, folder: Path, socket: Path, lock: int) -> None:
        state = Project(folder).state
        previous = read_info(state)
        if previous is not None and previous.get("token"):
            # A supervisor that was killed together with its guard.
            end_processes_with(previous["token"])
        self._loop = EventLoop(SystemClock())
        self._log = LogStore(state, self._loop)
        self._manager = ProcessManager(hold=[lock])
        self._arguments: dict[str, str] = {}
        self._over = False
        self._linger: Call | None = None
        self._supervisor = Supervisor(
            self._manager, self._loop, self._log, on_idle=self._exit_when_idle
        )
        self._server = RequestServer(socket, self._loop, handler=self._handle)
        guard = self._manager.guard()
        assert guard is not None, "supervisors run on POSIX systems only"
        info = {"pid": os.getpid(), "folder": str(folder), "token": guard.token}
        self._info = state / INFO_NAME
        try:
            self._info.write_text(json.dumps(info), encoding="utf-8")
        except OSError as error:  # a full disk: the services start, and `ps` reports it
            text = f"{self._info}: {error.strerror}"
            self._log.write("supervisor", "supervisor", [text], event=True)

    def run(self) -> None:
        self._install_signal_handlers()
        self._exit_when_idle()
        try:
            self._loop.run(done=lambda: self._over)
        finally:
            self._server.close()
            self._manager.close()
            self._log.close()
            self._info.unlink(missing_ok=True)

    def _handle(self, request: dict[str, Any]) -> dict[str, Any]:
        command = request.get("command")
        if command in ("up", "restart"):
            specs = [ServiceConfig.from_json(each) for each in request["services"]]
            environ = _texts(request["environ"])
            self._arguments = _texts(request["arguments"])
            if command == "up":
                self._supervisor.up(specs, environ)
            else:
                self._supervisor.restart(specs, environ)
        elif command == "down":
            self._supervisor.down(request.get("services"))
        elif command != "status":
            raise ValueError(
                f"command {command!r}: expected up, restart, down or status"
            )
        return {
            "pid": os.getpid(),
            "services": self._supervisor.status(),
            "arguments": self._arguments,
            "log_problem": self._log.problem,
        }

    def _exit_when_idle(self) -> None:
        if self._linger is None:
            at_ns = self._loop.clock.now_ns + round(_LINGER_S * 1e9)
            self._linger = self._loop.call_at(at_ns, self._exit_if_idle, "linger")

    def _exit_if_idle(self) -> None:
        self._linger = None
        self._over = self._supervisor.is_idle

    def _install_signal_handlers(self) -> None:
        """Stop all services, then the supervisor, on SIGINT and SIGTERM.

        A handler only queues: it may interrupt a holder of the loop's locks.
        """
        received: queue.SimpleQueue[int] = queue.SimpleQueue()
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda signum, frame: received.put(signum))
        signal.signal(signal.SIGHUP, signal.SIG_IGN)

        def watch() -> None:
            while True:
                received.get()
                self._loop.call_soon_threadsafe(self._supervisor.down, "signal")

        threading.Thread(target=watch, daemon=True).start()


def _texts(values: dict[Any, Any]) -> dict[str, str]:
    return {str(name): str(value) for name, value in values.items()}


if __name__ == "__main__":
    if os.fork() != 0:  # the command does not wait for the daemon's end
        os._exit(0)
    main(Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3]))
