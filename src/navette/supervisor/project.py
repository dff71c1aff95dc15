"""Project of a folder, and where its supervisor stores its state.

A project is the folder of the nearest ``navette.yaml``, in this folder or above.
"""

import fcntl
import hashlib
import json
import os
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from navette.errors import FileFormatError

FILE_NAME = "navette.yaml"
INFO_NAME = "supervisor.json"
STATE_VARIABLE = "NAVETTE_STATE_DIR"
_PRIVATE = 0o700
_MAX_SOCKET_PATH = 100  # bytes; the smallest limit of any system is 104


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
        return is_locked(self.state)


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
    """Return ``NAVETTE_STATE_DIR``, or Navette's folder for state of the user."""
    given = os.environ.get(STATE_VARIABLE)
    if given:
        return Path(given).expanduser()
    home = os.environ.get("XDG_STATE_HOME") or "~/.local/state"
    return Path(home).expanduser() / "navette"


def socket_path(state: Path) -> Path:
    """Return the path of the supervisor's socket, outside ``state``.

    Paths of sockets are limited in length.

    Raises:
        FileFormatError: other users have access to its folder.
    """
    digest = hashlib.sha256(str(state).encode()).hexdigest()[:20]
    bases = (os.environ.get("XDG_RUNTIME_DIR") or "", tempfile.gettempdir(), "/tmp")
    folders = [Path(base) / f"navette-{os.getuid()}" for base in bases if base]
    fitting = (f for f in folders if len(f"{f}/{digest}.sock") <= _MAX_SOCKET_PATH)
    folder = next(fitting, folders[-1])
    folder.mkdir(mode=_PRIVATE, exist_ok=True)
    found = folder.lstat()
    if found.st_uid != os.getuid() or found.st_mode & 0o077:
        raise FileFormatError(
            folder, "accessible to other users; remove it or set its mode to 700"
        )
    return folder / f"{digest}.sock"


def make_private(folder: Path) -> None:
    """Create a folder that only this user can access."""
    folder.mkdir(mode=_PRIVATE, parents=True, exist_ok=True)


def read_info(state: Path) -> dict[str, Any] | None:
    """Return the ``pid``, ``folder`` and ``token`` that a supervisor stored."""
    try:
        info = json.loads((state / INFO_NAME).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return info if isinstance(info, dict) and {"pid", "folder"} <= info.keys() else None


def lock_path(state: Path) -> Path:
    return state / "lock"


def is_locked(state: Path) -> bool:
    """Return whether a process holds the lock; the kernel releases it at its end."""
    try:
        descriptor = os.open(lock_path(state), os.O_RDWR)
    except FileNotFoundError:
        return False
    try:
        return not try_lock(descriptor)
    finally:
        os.close(descriptor)


def try_lock(descriptor: int) -> bool:
    """Take the lock if it is free."""
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
