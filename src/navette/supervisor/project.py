"""Project of a folder, and where its supervisor stores its state.

A project is the folder of the nearest ``navette.yaml``, in this folder or above.
"""

import hashlib
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from navette.errors import FileFormatError, NavetteError
from navette.files.folders import can_write, private_folder, temporary_folder
from navette.files.runs.locks import is_locked

FILE_NAME = "navette.yaml"
INFO_NAME = "supervisor.json"
STATE_VARIABLE = "NAVETTE_STATE_DIR"
_MAX_SOCKET_PATH = 100  # bytes; the smallest limit of any system is 104


class SupervisorError(NavetteError):
    """The supervisor is unreachable, or refused a request."""


@dataclass(frozen=True)
class Project:
    """A folder with services; ``file`` is None for the built-in ones."""

    folder: Path
    file: Path | None = None

    @property
    def state(self) -> Path:
        """State folder of its supervisor: log, lock, info file."""
        digest = hashlib.sha256(str(self.folder).encode()).hexdigest()[:10]
        return state_root() / f"{self.folder.name or 'root'}-{digest}"

    @property
    def is_supervised(self) -> bool:
        """Whether a supervisor runs, or its guard still ends its processes."""
        return is_supervised(self.state)


def find_project(start: Path, file: Path | None = None) -> Project:
    """Return the project of a folder.

    Without a ``navette.yaml``: the nearest folder above whose built-in services run,
    else ``start``.

    Raises:
        FileFormatError: ``file`` does not exist.
    """
    if file is not None:
        if not file.is_file():
            raise FileFormatError(file, "no such file")
        return Project(file.resolve().parent, file.resolve())
    start = start.resolve()
    for folder in (start, *start.parents):
        if (folder / FILE_NAME).is_file():
            return Project(folder, folder / FILE_NAME)
    for folder in (start, *start.parents):
        if Project(folder).is_supervised:
            return Project(folder)
    return Project(start)


def state_root() -> Path:
    """Return ``NAVETTE_STATE_DIR``, or Navette's folder for state of the user.

    Where that cannot be written, a folder among the temporary files.

    Raises:
        SupervisorError: no writable folder exists.
    """
    given = os.environ.get(STATE_VARIABLE)
    if given:
        return Path(given).expanduser()
    home = os.environ.get("XDG_STATE_HOME") or "~/.local/state"
    usual = Path(home).expanduser() / "navette"
    with _folder_errors():
        return usual if can_write(usual) else temporary_folder() / "state"


def socket_path(state: Path) -> Path:
    """Return the path of the supervisor's socket, outside ``state``.

    Paths of sockets are limited in length.

    Raises:
        SupervisorError: no folder exists for it that only this user can write.
    """
    name = f"{hashlib.sha256(str(state).encode()).hexdigest()[:20]}.sock"
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    with _folder_errors():
        if runtime and can_write(Path(runtime)):
            path = Path(runtime) / f"navette-{os.getuid()}" / name
            if len(str(path)) <= _MAX_SOCKET_PATH:
                return private_folder(path.parent) / name
        path = temporary_folder() / name
        if len(str(path)) <= _MAX_SOCKET_PATH:
            return path
        return private_folder(Path("/tmp", f"navette-{os.getuid()}")) / name


def create_state(project: Project) -> Path:
    """Create the state folder of a project.

    Raises:
        SupervisorError: it cannot be written, or other users can write it.
    """
    with _folder_errors():
        return private_folder(project.state)


@contextmanager
def _folder_errors() -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise SupervisorError(
            f"no folder for the supervisor's log and socket: {error}; set "
            f"{STATE_VARIABLE} and XDG_RUNTIME_DIR to folders that you can write"
        ) from error


def read_info(state: Path) -> dict[str, Any] | None:
    """Return the ``pid``, ``folder`` and ``token`` that a supervisor stored."""
    try:
        info = json.loads((state / INFO_NAME).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return info if isinstance(info, dict) and {"pid", "folder"} <= info.keys() else None


def is_supervised(state: Path) -> bool:
    """Return whether a process holds the lock; the kernel releases it at its end."""
    return is_locked(lock_path(state))


def lock_path(state: Path) -> Path:
    return state / "lock"
