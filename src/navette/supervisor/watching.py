"""Which files of a module changed: looked at again and again, without a library.

Why not a library: a module has some dozens of files, and reading their times takes
well under a millisecond.
"""

import os
from collections.abc import Iterable, Iterator
from pathlib import Path

_SUFFIXES = {".py", ".yaml", ".yml", ".xml", ".toml", ".cfg", ".msg", ".srv", ".action"}
_SKIPPED = {"build", "install", "log", "node_modules", "__pycache__"}
_MOST_FILES = 5000


class FileWatch:
    """Remembers how files were, and tells which are different now.

    Args:
        paths: files, and folders with all that is below them.
    """

    def __init__(self, paths: Iterable[str | Path]) -> None:
        self._paths = [Path(path) for path in paths]
        self._seen = self._look()

    @property
    def count(self) -> int:
        """How many files there are."""
        return len(self._seen)

    def changed(self) -> list[Path]:
        """Files that changed, came or went since the last call."""
        now, before = self._look(), self._seen
        self._seen = now
        return sorted(
            path
            for path in now.keys() | before.keys()
            if now.get(path) != before.get(path)
        )

    def _look(self) -> dict[Path, tuple[int, int]]:
        found: dict[Path, tuple[int, int]] = {}
        for path in self._paths:
            for file in _files(path) if path.is_dir() else [path]:
                if len(found) >= _MOST_FILES:
                    return found
                try:
                    state = file.stat()
                except OSError:
                    continue  # gone; that is a change, too
                found[file] = (state.st_mtime_ns, state.st_size)
        return found


def _files(folder: Path) -> Iterator[Path]:
    try:
        entries = sorted(os.scandir(folder), key=lambda entry: entry.name)
    except OSError:
        return
    for entry in entries:
        if entry.name.startswith(".") or entry.name in _SKIPPED:
            continue
        if entry.is_dir(follow_symlinks=False):
            yield from _files(Path(entry.path))
        elif Path(entry.name).suffix in _SUFFIXES:
            yield Path(entry.path)
