"""Which project one stands in, and where its supervisor keeps what it knows.

A project is a folder: that of the ``navette.yaml`` found in this folder or above.
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
WHO_NAME = "supervisor.json"
STATE_VARIABLE = "NAVETTE_STATE_DIR"
_PRIVATE = 0o700
_LONGEST_SOCKET = 100  # bytes; the least that any system takes is 104


@dataclass(frozen=True)
class Project:
    """A folder with modules; ``file`` None: the built-in ones."""

    folder: Path
    file: Path | None = None

    @property
    def state(self) -> Path:
        """The folder of its supervisor: log, lock, who it is."""
        digest = hashlib.sha256(str(self.folder).encode()).hexdigest()[:10]
        return state_root() / f"{self.folder.name or 'root'}-{digest}"

    @property
    def is_supervised(self) -> bool:
        """Whether a supervisor lives, or its guard still ends what it left."""
        return is_locked(self.state)


def find_project(start: Path, file: Path | None = None) -> Project:
    """The project of a folder.

    Without any ``navette.yaml``: the nearest folder above whose built-in modules run,
    or this one.

    Raises:
        FileFormatError: the file that was asked for is not there.
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
    """``NAVETTE_STATE_DIR``, or navette's folder where programs keep their state."""
    given = os.environ.get(STATE_VARIABLE)
    if given:
        return Path(given).expanduser()
    home = os.environ.get("XDG_STATE_HOME") or "~/.local/state"
    return Path(home).expanduser() / "navette"


def socket_path(state: Path) -> Path:
    """The supervisor's socket. Not in ``state``: its path could be too long for one.

    Raises:
        FileFormatError: the folder for it belongs to somebody else.
    """
    digest = hashlib.sha256(str(state).encode()).hexdigest()[:20]
    bases = (os.environ.get("XDG_RUNTIME_DIR") or "", tempfile.gettempdir(), "/tmp")
    folders = [Path(base) / f"navette-{os.getuid()}" for base in bases if base]
    fitting = (f for f in folders if len(f"{f}/{digest}.sock") <= _LONGEST_SOCKET)
    folder = next(fitting, folders[-1])
    folder.mkdir(mode=_PRIVATE, exist_ok=True)
    found = folder.lstat()
    if found.st_uid != os.getuid() or found.st_mode & 0o077:
        raise FileFormatError(folder, "not this user's alone; remove it")
    return folder / f"{digest}.sock"


def make_private(folder: Path) -> None:
    """Make a folder that only this user can look into."""
    folder.mkdir(mode=_PRIVATE, parents=True, exist_ok=True)


def read_who(state: Path) -> dict[str, Any] | None:
    """What a supervisor said of itself: its ``pid``, ``folder`` and ``token``."""
    try:
        told = json.loads((state / WHO_NAME).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return told if isinstance(told, dict) and {"pid", "folder"} <= told.keys() else None


def lock_of(state: Path) -> Path:
    return state / "lock"


def is_locked(state: Path) -> bool:
    """Whether somebody holds the lock; the kernel lets it go with the last holder."""
    try:
        descriptor = os.open(lock_of(state), os.O_RDWR)
    except FileNotFoundError:
        return False
    try:
        return not try_lock(descriptor)
    finally:
        os.close(descriptor)


def try_lock(descriptor: int) -> bool:
    """Take the lock if nobody has it."""
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
