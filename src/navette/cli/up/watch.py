"""Restart services when their files change.

The files are polled: a service has some dozens, whose times are read in well under a
millisecond.
"""

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

from navette.cli.stderr import note
from navette.cli.up.config import ProjectConfig
from navette.errors import NavetteError
from navette.supervisor.client import SupervisorClient
from navette.supervisor.service_config import ServiceConfig

_SUFFIXES = {".py", ".yaml", ".yml", ".xml", ".toml", ".cfg", ".msg", ".srv", ".action"}
_SKIPPED = {"build", "install", "log", "node_modules", "__pycache__"}
_MAX_FILES = 5000


class FileWatch:
    """Detects changed, new and deleted files.

    Args:
        paths: files, and folders with everything below them.
    """

    def __init__(self, paths: Iterable[str | Path]) -> None:
        self._paths = [Path(path) for path in paths]
        self._seen = self._scan()

    @property
    def count(self) -> int:
        return len(self._seen)

    def changed(self) -> list[Path]:
        """Return the files that changed since the last call."""
        now, before = self._scan(), self._seen
        self._seen = now
        return sorted(
            path
            for path in now.keys() | before.keys()
            if now.get(path) != before.get(path)
        )

    def _scan(self) -> dict[Path, tuple[int, int]]:
        found: dict[Path, tuple[int, int]] = {}
        for path in self._paths:
            for file in _files(path) if path.is_dir() else [path]:
                if len(found) >= _MAX_FILES:
                    return found
                try:
                    state = file.stat()
                except OSError:
                    continue  # deleted, which is a change as well
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


ReadProject = Callable[[], tuple[ProjectConfig, list[str]]]
"""Reads the project's file; returns it and the chosen services."""


class ServiceWatch:
    """Watches the files of services and the project's own file."""

    def __init__(self, client: SupervisorClient, *, read: ReadProject) -> None:
        self._client = client
        self._read = read
        config, names = read()
        self._file = config.path
        self._arguments = config.arguments
        self._file_watch = FileWatch([self._file])
        self._watch(config.specs(names or config.names))

    def _watch(self, specs: Sequence[ServiceConfig]) -> None:
        self._specs = {spec.name: spec for spec in specs}
        self._watches = {spec.name: FileWatch(spec.watched) for spec in specs}

    def describe(self) -> str:
        counts = [f"{name} ({w.count})" for name, w in self._watches.items()]
        return f"the files of {', '.join(counts)}, and {self._file.name}"

    def poll(self) -> None:
        """Restart the services whose files changed since the last call."""
        if self._file_watch.changed():
            self._reread()
            return
        changes = {name: watch.changed() for name, watch in self._watches.items()}
        names = [name for name, paths in changes.items() if paths]
        if names:
            paths = sorted({path for found in changes.values() for path in found})
            others = " and others" if len(paths) > 1 else ""
            note(f"{paths[0].name}{others} changed: restarting {', '.join(names)}")
            specs = [self._specs[name] for name in names]
            self._client.restart(specs, self._arguments)

    def _reread(self) -> None:
        try:
            config, names = self._read()
            specs = config.specs(names or config.names)
        except NavetteError as error:
            note(f"nothing was restarted: {error}")
            return
        changed = [spec for spec in specs if self._specs.get(spec.name) != spec]
        self._watch(specs)
        if changed:
            names = [spec.name for spec in changed]
            note(f"{self._file.name} changed: restarting {', '.join(names)}")
            self._client.restart(changed, self._arguments)
