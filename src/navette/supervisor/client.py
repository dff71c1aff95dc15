"""Client of a project's supervisor; starts the supervisor if necessary."""

import json
import os
import select
import socket
import subprocess
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from navette.supervisor.guard import without_tokens
from navette.supervisor.project import (
    INFO_NAME,
    Project,
    SupervisorError,
    create_state,
    is_supervised,
    read_info,
    socket_path,
    state_root,
)
from navette.supervisor.service_config import ServiceConfig

_TIMEOUT_S = 15.0
_START_TIMEOUT_S = 30.0
_MAX_ERROR_BYTES = 1000
LOG_NAME = "supervisor.log"


class SupervisorClient:
    """Sends requests to the supervisor of a project."""

    def __init__(self, project: Project) -> None:
        self.project = project
        self._socket = socket_path(project.state)

    def is_reachable(self) -> bool:
        """Return whether a supervisor accepts connections."""
        return accepts_connections(self._socket)

    def status(self) -> list[dict[str, Any]]:
        """Return the services that are up; empty without a supervisor."""
        try:
            return _services(self._request({"command": "status"}))
        except ConnectionError:
            return []

    def arguments(self) -> dict[str, str]:
        """Return the arguments of the last ``up``; they hold until all is down."""
        try:
            found: dict[str, str] = self._request({"command": "status"})["arguments"]
        except ConnectionError:
            return {}
        return found

    def log_problem(self) -> str:
        """Return why output is not stored at present, or ""."""
        try:
            found: str = self._request({"command": "status"})["log_problem"]
        except ConnectionError:
            return ""
        return found

    def up(
        self, services: Iterable[ServiceConfig], arguments: Mapping[str, str]
    ) -> list[dict[str, Any]]:
        """Start services, and the supervisor if necessary.

        Args:
            arguments: the arguments that the project's file was read with.
        """
        return self._send("up", services, arguments)

    def restart(
        self, services: Iterable[ServiceConfig], arguments: Mapping[str, str]
    ) -> list[dict[str, Any]]:
        """Stop services and start them again."""
        return self._send("restart", services, arguments)

    def down(self, services: Iterable[str] | None) -> list[dict[str, Any]]:
        """Stop services (None: all).

        Raises:
            SupervisorError: one of them is not up.
        """
        names = None if services is None else list(services)
        try:
            return _services(self._request({"command": "down", "services": names}))
        except ConnectionError:
            if names:
                raise SupervisorError(
                    f"nothing is up in {self.project.folder}"
                ) from None
            return []

    def _send(
        self,
        command: str,
        services: Iterable[ServiceConfig],
        arguments: Mapping[str, str],
    ) -> list[dict[str, Any]]:
        request = {
            "command": command,
            "services": [each.to_json() for each in services],
            "arguments": dict(arguments),
            "environ": without_tokens(os.environ),
        }
        try:
            return _services(self._request(request))
        except ConnectionError:
            start_supervisor(self.project, self._socket)
        try:
            return _services(self._request(request))
        except ConnectionError as error:
            raise SupervisorError(
                f"the supervisor of {self.project.folder} does not respond: {error}"
            ) from error

    def _request(self, request: dict[str, Any]) -> dict[str, Any]:
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as connection:
            connection.settimeout(_TIMEOUT_S)
            try:
                connection.connect(str(self._socket))
            except FileNotFoundError:
                raise ConnectionRefusedError from None
            try:
                with connection.makefile("rwb") as file:
                    file.write(json.dumps(request).encode() + b"\n")
                    file.flush()
                    line = file.readline()
            except TimeoutError:
                raise SupervisorError(
                    f"the supervisor of {self.project.folder} does not respond within "
                    f"{_TIMEOUT_S:g} s"
                ) from None
        if not line:
            raise ConnectionResetError
        response: dict[str, Any] = json.loads(line)
        if "error" in response:
            raise SupervisorError(response["error"])
        return response


def _services(response: dict[str, Any]) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = response["services"]
    return found


def accepts_connections(path: Path) -> bool:
    """Return whether a process listens on a socket."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as connection:
        connection.settimeout(_TIMEOUT_S)
        try:
            connection.connect(str(path))
        except OSError:
            return False
    return True


def known_projects() -> list[Project]:
    """Return the projects of this user that have a supervisor."""
    found = []
    for file in sorted(state_root().glob(f"*/{INFO_NAME}")):
        info = read_info(file.parent)
        if info is not None and is_supervised(file.parent):
            found.append(Project(Path(info["folder"])))
    return found


def killed_supervisor(project: Project) -> int | None:
    """Return the process id of a supervisor that was killed, if there is one."""
    info = read_info(project.state)
    if info is None or is_supervised(project.state):
        return None
    return int(info["pid"])


def start_supervisor(project: Project, path: Path) -> None:
    """Start a detached supervisor and wait until it listens.

    Raises:
        SupervisorError: it did not start; includes its output.
    """
    log = create_state(project) / LOG_NAME
    reading, writing = os.pipe()
    with log.open("wb") as output:
        subprocess.run(
            [
                *(sys.executable, "-m", "navette.supervisor.daemon"),
                *(str(project.folder), str(path), str(writing)),
            ],
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=output,
            cwd="/",
            env=without_tokens(os.environ),
            start_new_session=True,
            pass_fds=(writing,),
            check=False,
        )
    os.close(writing)
    ready, _, _ = select.select([reading], [], [], _START_TIMEOUT_S)
    result = os.read(reading, _MAX_ERROR_BYTES) if ready else b""
    os.close(reading)
    if result not in (b"ready", b"taken"):
        text = result.decode() or log.read_text(encoding="utf-8", errors="replace")
        reason = text.strip() or "no output"
        raise SupervisorError(f"the supervisor did not start: {reason}")
