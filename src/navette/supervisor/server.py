"""Server of the supervisor's socket: JSON requests and responses, one per line."""

import json
import socket
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from navette.errors import NavetteError
from navette.runtime.loop import EventLoop

_MAX_BYTES = 16 << 20
_TIMEOUT_S = 10.0

RequestHandler = Callable[[dict[str, Any]], dict[str, Any]]
"""Returns the response to a request. Navette's exceptions become error responses."""


class RequestServer:
    """Serves requests on a Unix socket that only this user can access.

    Args:
        path: of the socket; an existing one is replaced.
        handler: called on the loop.
    """

    def __init__(self, path: Path, loop: EventLoop, *, handler: RequestHandler) -> None:
        self._path = path
        self._loop = loop
        self._handler = handler
        path.unlink(missing_ok=True)
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._socket.bind(str(path))
        path.chmod(0o600)
        self._socket.listen(16)
        threading.Thread(target=self._accept, daemon=True).start()

    def close(self) -> None:
        self._path.unlink(missing_ok=True)
        self._socket.close()

    def _accept(self) -> None:
        while True:
            try:
                connection, _ = self._socket.accept()
            except OSError:  # closed
                return
            threading.Thread(
                target=self._serve, args=(connection,), daemon=True
            ).start()

    def _serve(self, connection: socket.socket) -> None:
        with connection, connection.makefile("rwb") as file:
            connection.settimeout(_TIMEOUT_S)
            try:
                line = file.readline(_MAX_BYTES)
                file.write(json.dumps(self._respond(line)).encode() + b"\n")
                file.flush()
            except OSError:
                return  # the client has left, or is too slow

    def _respond(self, line: bytes) -> dict[str, Any]:
        try:
            request = json.loads(line)
        except ValueError:
            return {"error": "malformed request: not JSON"}
        if not isinstance(request, dict):
            return {"error": "malformed request: expected an object"}
        response: dict[str, Any] = {}
        done = threading.Event()

        def handle() -> None:
            try:
                response.update(self._handler(request))
            except NavetteError as error:
                response["error"] = str(error)
            except (KeyError, TypeError, ValueError) as error:
                response["error"] = f"malformed request: {error!r}"
            done.set()

        self._loop.call_soon_threadsafe(handle, "request")
        timed_out = {"error": f"no response within {_TIMEOUT_S:g} s"}
        return response if done.wait(_TIMEOUT_S) else timed_out
