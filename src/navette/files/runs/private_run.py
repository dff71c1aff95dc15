"""A private run of this process: its name, its lock and its entry."""

import os
import threading
from collections.abc import Iterator
from dataclasses import replace
from itertools import count
from pathlib import Path

from navette.errors import FileFormatError, InvalidValueError, NetworkError
from navette.files.runs.entry import MAX_TEXT, RunInfo, check_run_name
from navette.files.runs.folder import (
    existing_folders,
    make_private,
    runtime_folder,
)
from navette.files.runs.locks import FileLock, is_locked
from navette.files.runs.registry import ENTRY, LOCK, RUNS, live_runs

# "/runs/", a name of 24 bytes, "/", and a socket of 13 bytes.
_LONGEST_PATH = 44
_SOCKETS = "*.sock.lock"
# How often, and at which intervals, a name is looked for that is being withdrawn.
_WITHDRAWALS, _PAUSE_S = 20, 0.02


class PrivateRun:
    """A claimed name: other programs of the user find the run once it is published.

    Attributes:
        info: the entry.
    """

    def __init__(self, info: RunInfo, lock: FileLock) -> None:
        self.info = info
        self._lock = lock

    @classmethod
    def claim(
        cls, kind: str, *, name: str = "", world: str = "", domain: int = 0
    ) -> "PrivateRun":
        """Take a name that no living run has.

        Args:
            kind: verb that starts the run; its name, with a number if necessary.
            name: the name to take instead.
            world: name of the world, for lists of runs.

        Raises:
            NetworkError: no private folder exists for sockets and locks.
            InvalidValueError: the name is invalid, or a living run has it.
        """
        runs = _folder_of_runs()
        # Also in the folders of other terminals, whose locks are elsewhere.
        taken = {run.name for run in live_runs()}
        for candidate in [check_run_name(name)] if name else _names(kind):
            if candidate in taken:
                continue
            folder = runs / candidate
            make_private(folder)
            lock = FileLock.take(folder / LOCK)
            if lock is not None and _is_claimed_elsewhere(folder):
                lock.release()
                lock = None
            if lock is not None:
                (folder / ENTRY).unlink(missing_ok=True)
                _remove_sockets_of_killed_programs(folder)
                info = RunInfo(
                    folder=folder,
                    name=candidate,
                    command=f"navette {kind}",
                    world=_printable(world),
                    pid=os.getpid(),
                    domain=domain,
                )
                return cls(info, lock)
        living = ", ".join(run.name for run in live_runs())
        raise InvalidValueError(
            f"run {name or kind!r} exists already (runs: {living}); end it or choose "
            "another name (NAVETTE_RUN)"
        )

    def publish(self, page: str) -> None:
        """Let other programs of the user find the run.

        Args:
            page: address of the live view; empty without one.
        """
        self.info = replace(self.info, page=page)
        written = self.info.folder / f"{ENTRY}.new"
        written.write_text(self.info.to_json(), encoding="utf-8")
        written.replace(self.info.folder / ENTRY)

    def close(self) -> None:
        """Withdraw the entry and release the name; a second call has no effect."""
        if self._lock.is_held:
            (self.info.folder / ENTRY).unlink(missing_ok=True)
            self._lock.release()


def _folder_of_runs() -> Path:
    if os.name != "posix":
        raise NetworkError("private runs need Linux or macOS")
    try:
        runs = runtime_folder(_LONGEST_PATH) / RUNS
        make_private(runs)
    except FileFormatError as error:
        raise NetworkError(f"no private folder: {error}") from error
    return runs


def _is_claimed_elsewhere(own: Path) -> bool:
    """Whether another program holds the run's name in another runtime folder.

    Of two programs that claim a name at the same instant, the one whose folder comes
    first in the alphabet keeps it: it gives the other one time to withdraw.
    """
    pause = threading.Event()
    for folder in existing_folders():
        other = folder / RUNS / own.name
        if other == own:
            continue
        for _ in range(_WITHDRAWALS if own < other else 1):
            if not is_locked(other / LOCK):
                break
            pause.wait(_PAUSE_S)
        else:
            return True
    return False


def _names(kind: str) -> Iterator[str]:
    yield kind
    for number in count(2):
        yield f"{kind}-{number}"


def _printable(text: str) -> str:
    return "".join(c if c.isprintable() else "?" for c in text)[:MAX_TEXT]


def _remove_sockets_of_killed_programs(folder: Path) -> None:
    for lock in folder.glob(_SOCKETS):
        if not is_locked(lock):
            lock.with_suffix("").unlink(missing_ok=True)
            lock.unlink(missing_ok=True)
