"""The supervisor process: one per project, detached from the process that started it.

Started as ``python -m navette.supervisor.daemon FOLDER SOCKET READY_FD``. It exits when
no module is left; every process that it started ends with it, however it ends.
"""

import json
import os
import queue
import signal
import sys
import threading
from pathlib import Path
from typing import Any

from navette.runtime import SystemClock
from navette.runtime.events import Call
from navette.runtime.loop import EventLoop
from navette.supervisor import Keeper, sweep
from navette.supervisor.client import answers
from navette.supervisor.log_book import LogBook
from navette.supervisor.project import (
    WHO_NAME,
    Project,
    lock_of,
    make_private,
    read_who,
    try_lock,
)
from navette.supervisor.server import Server
from navette.supervisor.specs import ModuleSpec
from navette.supervisor.supervisor import Supervisor

# A guard that ends what a killed supervisor left holds the lock meanwhile.
_LOCK_S = 15.0
_LOOK_S = 0.05
# So long it waits for more to do: who said "down" still asks how it went.
_LINGER_S = 0.5


def main(folder: Path, socket: Path, ready: int) -> None:
    """Supervise the project of a folder until no module is left."""
    state = Project(folder).state
    make_private(state)
    lock = os.open(lock_of(state), os.O_RDWR | os.O_CREAT, 0o600)
    if not _locked(lock, socket):
        os.write(ready, b"taken")  # somebody else was faster; all is well
        return
    daemon = _Daemon(folder, socket, lock)
    os.write(ready, b"ready")
    os.close(ready)
    daemon.run()


def _locked(lock: int, socket: Path) -> bool:
    """Take the lock; False once another supervisor answers, or it takes too long."""
    pause, left_s = threading.Event(), _LOCK_S
    while not try_lock(lock):
        if answers(socket) or left_s <= 0:
            return False
        pause.wait(_LOOK_S)
        left_s -= _LOOK_S
    return True


def _end_leftovers(state: Path) -> None:
    """Of a supervisor that was killed together with its guard."""
    before = read_who(state)
    if before is not None and before.get("token"):
        sweep(before["token"])


class _Daemon:
    """A supervisor with its loop, log and socket."""

    def __init__(self, folder: Path, socket: Path, lock: int) -> None:
        state = Project(folder).state
        self._who = state / WHO_NAME
        _end_leftovers(state)
        self._loop = EventLoop(SystemClock())
        self._log = LogBook(state, lambda: self._loop.clock.now_ns)
        self._keeper = Keeper(hold=[lock])
        self._arguments: dict[str, str] = {}
        self._over = False
        self._farewell: Call | None = None
        self._supervisor = Supervisor(
            self._keeper, self._loop, self._log, self._become_idle
        )
        self._server = Server(socket, self._loop, self._handle)
        told = {
            "pid": os.getpid(),
            "folder": str(folder),
            "token": self._keeper.token,
        }
        self._who.write_text(json.dumps(told), encoding="utf-8")

    def run(self) -> None:
        self._listen_to_signals()
        self._become_idle()
        try:
            self._loop.run(done=lambda: self._over)
        finally:
            self._server.close()
            self._keeper.close()
            self._log.close()
            self._who.unlink(missing_ok=True)

    def _handle(self, request: dict[str, Any]) -> dict[str, Any]:
        wish = request.get("do")
        if wish in ("up", "restart"):
            specs = [ModuleSpec.from_json(each) for each in request["modules"]]
            environ = _texts(request["environ"])
            self._arguments = _texts(request["arguments"])
            act = self._supervisor.up if wish == "up" else self._supervisor.restart
            act(specs, environ)
        elif wish == "down":
            self._supervisor.down(request.get("modules"))
        elif wish != "status":
            raise ValueError(f"do: {wish!r}; wanted up, restart, down or status")
        return {
            "pid": os.getpid(),
            "modules": self._supervisor.status(),
            "arguments": self._arguments,
        }

    def _become_idle(self) -> None:
        if self._farewell is None:
            at_ns = self._loop.clock.now_ns + round(_LINGER_S * 1e9)
            self._farewell = self._loop.call_at(at_ns, self._leave, "farewell")

    def _leave(self) -> None:
        self._farewell = None
        self._over = self._supervisor.is_idle

    def _listen_to_signals(self) -> None:
        """SIGINT and SIGTERM end all modules, and then the supervisor.

        A handler only queues: it may interrupt whoever holds the loop's locks.
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
    if os.fork() != 0:  # so that whoever started it need not wait for its end
        os._exit(0)
    main(Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3]))
