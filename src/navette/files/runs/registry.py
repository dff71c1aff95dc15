"""Registry of the user's runs: a folder for each, whose lock its program holds.

::

    <runtime folder>/runs/demo/lock         held while the run lives
                              run.json      its entry
                              router.sock   where its programs discover each other
                              4711-1.sock   where its program 4711 is reached

The kernel releases the lock of a killed program, so that its entry has no effect.
"""

import logging
import os
import stat
from collections.abc import Iterator
from pathlib import Path

from navette.errors import FileFormatError
from navette.files.runs.entry import MAX_BYTES, RunInfo, is_run_name
from navette.files.runs.folder import access_problem, existing_folders
from navette.files.runs.locks import is_locked

_log = logging.getLogger(__name__)

RUNS = "runs"
ENTRY = "run.json"
LOCK = "lock"


def live_runs() -> list[RunInfo]:
    """Return the user's runs, sorted by name; log entries that cannot be read."""
    return sorted(_runs(), key=lambda run: run.name)


def _runs() -> Iterator[RunInfo]:
    if os.name != "posix":
        return
    for folder in existing_folders():
        if access_problem(folder / RUNS) is not None:
            continue
        for run in (folder / RUNS).iterdir():
            if is_run_name(run.name) and is_locked(run / LOCK):
                try:
                    info = _read(run)
                except FileFormatError as error:
                    _log.warning("a run is ignored: %s", error)
                else:
                    if info is not None:
                        yield info


def _read(folder: Path) -> RunInfo | None:
    """Return the entry of a run; None while the run has not published it.

    Raises:
        FileFormatError: not an entry, not a file of this user, or too long.
    """
    path = folder / ENTRY
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise FileFormatError(path, f"cannot read: {error.strerror}") from error
    try:
        found = os.fstat(descriptor)
        if not stat.S_ISREG(found.st_mode) or found.st_uid != os.getuid():
            raise FileFormatError(path, "not a file of this user; remove it")
        content = os.read(descriptor, MAX_BYTES + 1)
    finally:
        os.close(descriptor)
    if len(content) > MAX_BYTES:
        raise FileFormatError(path, f"longer than {MAX_BYTES} bytes; remove it")
    try:
        return RunInfo.from_json(content.decode(), folder, found.st_mtime_ns)
    except UnicodeDecodeError:
        raise FileFormatError(path, "not UTF-8; remove it") from None
