"""The supervisor's socket: a line of JSON asks, a line of JSON answers."""

import json
import os
import socket
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from navette.errors import NavetteError
from navette.runtime.loop import EventLoop

MOST_BYTES = 16 << 20
_PATIENCE_S = 10.0

Handler = Callable[[dict[str, Any]], dict[str, Any]]


class Server:
    """Answers on a Unix socket, which only this user's folder leads to.

    Args:
        path: of the socket; one that is left over is replaced.
        handler: called on the loop with each request; what it raises of Navette's
            own errors is told to the asker.
    """

    def __init__(self, path: Path, loop: EventLoop, handler: Handler) -> None:
        self._path = path
        self._loop = loop
        self._handler = handler
        path.unlink(missing_ok=True)
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._socket.bind(str(path))
        os.chmod(path, 0o600)  # noqa: PTH101
        self._socket.listen(16)
        threading.Thread(target=self._accept, daemon=True).start()

    def close(self) -> None:
        """Answer no more."""
        self._path.unlink(missing_ok=True)
        self._socket.close()

    def _accept(self) -> None:
        while True:
            try:
                connection, _ = self._socket.accept()
            except OSError:  # it was closed
                return
            threading.Thread(
                target=self._serve, args=(connection,), daemon=True
            ).start()

    def _serve(self, connection: socket.socket) -> None:
        with connection, connection.makefile("rwb") as file:
            connection.settimeout(_PATIENCE_S)
            try:
                line = file.readline(MOST_BYTES)
                file.write(json.dumps(self._answer(line)).encode() + b"\n")
                file.flush()
            except OSError:
                return  # whoever asked is gone, or too slow

    def _answer(self, line: bytes) -> dict[str, Any]:
        try:
            request = json.loads(line)
        except ValueError:
            return {"error": "not JSON"}
        if not isinstance(request, dict):
            return {"error": "wanted an object"}
        answer: dict[str, Any] = {}
        done = threading.Event()

        def work() -> None:
            try:
                answer.update(self._handler(request))
            except NavetteError as error:
                answer["error"] = str(error)
            except (KeyError, TypeError, ValueError) as error:
                answer["error"] = f"malformed request: {error!r}"
            done.set()

        self._loop.call_soon_threadsafe(work, "request")
        return answer if done.wait(_PATIENCE_S) else {"error": "no answer in time"}
