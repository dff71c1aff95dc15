"""Talks to a project's supervisor, and starts it where there is none."""

import json
import os
import select
import socket
import subprocess
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from navette.errors import NavetteError
from navette.supervisor import without_marks
from navette.supervisor.project import (
    WHO_NAME,
    Project,
    is_locked,
    make_private,
    read_who,
    socket_path,
    state_root,
)
from navette.supervisor.specs import ModuleSpec

_PATIENCE_S = 15.0
_START_S = 30.0
LOG_NAME = "supervisor.log"


class SupervisorError(NavetteError):
    """The supervisor is not there, or refused."""


class Client:
    """A project's supervisor, from outside."""

    def __init__(self, project: Project) -> None:
        self.project = project
        self._socket = socket_path(project.state)

    def is_there(self) -> bool:
        """Whether a supervisor answers."""
        return answers(self._socket)

    def status(self) -> list[dict[str, Any]]:
        """All modules that are up; none where there is no supervisor."""
        try:
            return _modules(self._ask({"do": "status"}))
        except ConnectionError:
            return []

    def arguments(self) -> dict[str, str]:
        """Those with which modules were last started; they hold until all are down."""
        try:
            found: dict[str, str] = self._ask({"do": "status"})["arguments"]
        except ConnectionError:
            return {}
        return found

    def up(
        self, modules: Iterable[ModuleSpec], arguments: Mapping[str, str]
    ) -> list[dict[str, Any]]:
        """Start modules, and the supervisor first if need be.

        Args:
            arguments: with which the project's file was read.
        """
        return self._send("up", modules, arguments)

    def restart(
        self, modules: Iterable[ModuleSpec], arguments: Mapping[str, str]
    ) -> list[dict[str, Any]]:
        """End modules and start them again."""
        return self._send("restart", modules, arguments)

    def down(self, modules: Iterable[str] | None) -> list[dict[str, Any]]:
        """End modules (None: all).

        Raises:
            SupervisorError: one of them is not up.
        """
        names = None if modules is None else list(modules)
        try:
            return _modules(self._ask({"do": "down", "modules": names}))
        except ConnectionError:
            if names:
                raise SupervisorError(
                    f"nothing is up in {self.project.folder}"
                ) from None
            return []

    def _send(
        self, wish: str, modules: Iterable[ModuleSpec], arguments: Mapping[str, str]
    ) -> list[dict[str, Any]]:
        request = {
            "do": wish,
            "modules": [each.to_json() for each in modules],
            "arguments": dict(arguments),
            "environ": without_marks(os.environ),
        }
        try:
            return _modules(self._ask(request))
        except ConnectionError:
            start_supervisor(self.project, self._socket)
        try:
            return _modules(self._ask(request))
        except ConnectionError as error:
            raise SupervisorError(
                f"the supervisor of {self.project.folder} does not answer: {error}"
            ) from error

    def _ask(self, request: dict[str, Any]) -> dict[str, Any]:
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as connection:
            connection.settimeout(_PATIENCE_S)
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
                    f"the supervisor of {self.project.folder} does not answer"
                ) from None
        if not line:
            raise ConnectionResetError
        answer: dict[str, Any] = json.loads(line)
        if "error" in answer:
            raise SupervisorError(answer["error"])
        return answer


def _modules(answer: dict[str, Any]) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = answer["modules"]
    return found


def answers(path: Path) -> bool:
    """Whether somebody listens on a socket."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as connection:
        connection.settimeout(_PATIENCE_S)
        try:
            connection.connect(str(path))
        except OSError:
            return False
    return True


def known_projects() -> list[Project]:
    """Every project of this user that has a supervisor."""
    found = []
    for who in sorted(state_root().glob(f"*/{WHO_NAME}")):
        told = read_who(who.parent)
        if told is not None and is_locked(who.parent):
            found.append(Project(Path(told["folder"])))
    return found


def died(project: Project) -> int | None:
    """The process id of a supervisor that was killed; None if none was."""
    told = read_who(project.state)
    if told is None or is_locked(project.state):
        return None
    return int(told["pid"])


def start_supervisor(project: Project, path: Path) -> None:
    """Start one, detached, and wait until it listens.

    Raises:
        SupervisorError: it does not come up; says what it said.
    """
    make_private(project.state)
    reading, writing = os.pipe()
    log = project.state / LOG_NAME
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
            env=without_marks(os.environ),
            start_new_session=True,
            pass_fds=(writing,),
            check=False,
        )
    os.close(writing)
    with os.fdopen(reading, "rb") as pipe:
        there, _, _ = select.select([pipe], [], [], _START_S)
        word = pipe.read(5) if there else b""
    if word not in (b"ready", b"taken"):
        said = log.read_text(encoding="utf-8", errors="replace").strip()
        raise SupervisorError(f"the supervisor did not start: {said or 'no word'}")
