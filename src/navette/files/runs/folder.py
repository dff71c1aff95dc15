"""Folder for sockets and locks that only this user can access."""

import os
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path

from navette.errors import FileFormatError

VARIABLE = "NAVETTE_RUNTIME_DIR"
MAX_SOCKET_PATH = 100  # bytes; the smallest limit of any system is 104
_PRIVATE = 0o700
_OTHERS = 0o077
# Not part of a Zenoh endpoint, or with a meaning in it.
_SPECIAL = set("?#;,*$ \n")


def runtime_folder(longest_name: int) -> Path:
    """Return the folder, and create it if necessary.

    Args:
        longest_name: bytes of the longest path below it, as a socket's path is limited.

    Raises:
        FileFormatError: no such folder exists, or other users have access to it.
    """
    problem: FileFormatError | None = None
    for folder in _candidates():
        if len(os.fsencode(folder)) + 1 + longest_name > MAX_SOCKET_PATH:
            continue
        try:
            make_private(folder)
        except FileFormatError as error:
            problem = problem or error
        else:
            return folder
    raise problem or FileFormatError(
        tempfile.gettempdir(), f"no folder for sockets; set {VARIABLE} to a short path"
    )


def existing_folders() -> Iterator[Path]:
    """Return the folders that programs of this user may have chosen.

    Terminals of one user can differ in ``XDG_RUNTIME_DIR`` (``su``, ``ssh``, ``cron``).
    """
    for folder in _candidates():
        if access_problem(folder) is None:
            yield folder


def make_private(folder: Path) -> None:
    """Create a folder that only this user can access, or check it.

    Raises:
        FileFormatError: it cannot be created, or other users have access to it.
    """
    try:
        folder.mkdir(mode=_PRIVATE, exist_ok=True)
    except OSError as error:
        raise FileFormatError(folder, f"cannot create: {error.strerror}") from error
    problem = access_problem(folder)
    if problem is not None:
        raise FileFormatError(folder, problem)


def access_problem(folder: Path) -> str | None:
    """Return why other users could read or replace a folder's content; None: no one."""
    try:
        found, above = folder.lstat(), folder.parent.stat()
    except OSError as error:
        return str(error.strerror)
    if not stat.S_ISDIR(found.st_mode):
        return "is not a folder; remove it"
    if found.st_uid != os.getuid():
        return f"belongs to user {found.st_uid}; set {VARIABLE} to another folder"
    if found.st_mode & _OTHERS:
        return "accessible to other users; remove it or set its mode to 700"
    # A user who can rename the folder can replace it.
    if above.st_uid not in (0, os.getuid()) or (
        above.st_mode & 0o022 and not above.st_mode & stat.S_ISVTX
    ):
        return f"{folder.parent} is writable by other users; set {VARIABLE}"
    return None


def _candidates() -> Iterator[Path]:
    given = os.environ.get(VARIABLE)
    if given:
        yield Path(given).absolute()
        return
    own = f"navette-{os.getuid()}"
    bases = (
        os.environ.get("XDG_RUNTIME_DIR") or "",
        f"/run/user/{os.getuid()}",
        tempfile.gettempdir(),
        "/tmp",
    )
    for base in dict.fromkeys(bases):
        if base.startswith("/") and not _SPECIAL & set(base) and _is_folder(base):
            yield Path(base) / own


def _is_folder(path: str) -> bool:
    """Return whether a folder is there; not if it lies in another user's."""
    try:
        return stat.S_ISDIR(Path(path).stat().st_mode)
    except OSError:
        return False
