# SPDX-License-Identifier: Apache-2.0
"""Folders of the user that only the user can write, and what replaces them."""

import functools
import logging
import os
import sys
import tempfile
from pathlib import Path

VARIABLE = "XDG_CACHE_HOME"
_log = logging.getLogger(__name__)


def cache_folder(name: str, *, preferred: str | None = None) -> Path | None:
    """Return a writable folder for files that can be made again, or None.

    The user's cache folder, or ``preferred``; where that cannot be written, a folder
    among the temporary files, and a warning is logged.

    Args:
        name: folder within Navette's cache folder.
        preferred: folder that the user chose for this cache.
    """
    usual = Path(preferred).expanduser() if preferred else _user_cache()
    try:
        return private_folder(usual / "navette" / name)
    except OSError as error:
        problem = str(error)
    try:
        folder = private_folder(temporary_folder() / name)
    except OSError as error:
        _warn(name, f"{problem}; {error}", "none: each start takes longer")
        return None
    _warn(name, problem, str(folder))
    return folder


def temporary_folder() -> Path:
    """Return this user's folder among the temporary files.

    Raises:
        OSError: it cannot be created, or another user created it.
    """
    user = "" if sys.platform == "win32" else f"-{os.getuid()}"
    return private_folder(Path(tempfile.gettempdir()) / f"navette{user}")


def private_folder(folder: Path) -> Path:
    """Return a folder that only this user can write; create it if it is missing.

    Raises:
        OSError: it cannot be created or written, or other users can write it.
    """
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    if not is_private(folder.lstat()):
        raise PermissionError(
            f"other users can write {folder}: remove it, or set its mode to 700"
        )
    tempfile.TemporaryFile(dir=folder).close()
    return folder


def can_write(folder: Path) -> bool:
    """Return whether the folder can be written, or created if it is missing."""
    existing = next(each for each in (folder, *folder.parents) if each.exists())
    return os.access(existing, os.W_OK | os.X_OK)


def is_private(status: os.stat_result) -> bool:
    """Return whether only this user (or root) can write the file or folder."""
    if sys.platform == "win32":  # access lists protect the user's profile
        return True
    return status.st_uid in (0, os.getuid()) and not status.st_mode & 0o022


def _user_cache() -> Path:
    given = os.environ.get(VARIABLE)
    if given:
        return Path(given).expanduser()
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or "~").expanduser()
    return Path(
        "~/Library/Caches" if sys.platform == "darwin" else "~/.cache"
    ).expanduser()


@functools.cache
def _warn(name: str, problem: str, instead: str) -> None:
    _log.warning(
        "no cache folder for %s (%s), using %s; set %s to a writable folder",
        *(name, problem, instead, VARIABLE),
    )
