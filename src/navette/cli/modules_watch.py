"""Restarts modules when their files change."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from navette.cli.output import note
from navette.errors import NavetteError
from navette.supervisor.watching import FileWatch

if TYPE_CHECKING:
    from pathlib import Path

    from navette.supervisor.client import Client
    from navette.supervisor.project import Project
    from navette.supervisor.reading import ProjectFile
    from navette.supervisor.specs import ModuleSpec

Read = Callable[[], "tuple[Project, ProjectFile, list[str]]"]


class ChangeWatch:
    """The files of modules, and of the project itself.

    Args:
        read: reads the project's file anew.
    """

    def __init__(self, client: "Client", read: Read) -> None:
        self._client = client
        self._read = read
        _, content, names = read()
        self._file = content.path
        self._arguments = content.arguments
        self._project_watch = FileWatch([self._file])
        self._take(content.specs(names or content.names))

    def _take(self, specs: "Sequence[ModuleSpec]") -> None:
        self._specs = {spec.name: spec for spec in specs}
        self._watches = {spec.name: FileWatch(spec.watched) for spec in specs}

    @property
    def described(self) -> str:
        """What is watched, in words."""
        counts = [f"{name} ({w.count})" for name, w in self._watches.items()]
        return f"the files of {', '.join(counts)}, and {self._file.name}"

    def look(self) -> None:
        """Restart what has changed since the last look."""
        if self._project_watch.changed():
            self._reread()
            return
        changes = {name: watch.changed() for name, watch in self._watches.items()}
        names = [name for name, paths in changes.items() if paths]
        if names:
            paths = sorted({path for found in changes.values() for path in found})
            note(f"{_named(paths)}: restarting {', '.join(names)}")
            specs = [self._specs[name] for name in names]
            self._client.restart(specs, self._arguments)

    def _reread(self) -> None:
        try:
            _, content, names = self._read()
            specs = content.specs(names or content.names)
        except NavetteError as error:
            note(f"nothing was restarted: {error}")
            return
        different = [spec for spec in specs if self._specs.get(spec.name) != spec]
        self._take(specs)
        if different:
            names = [spec.name for spec in different]
            note(f"{self._file.name} changed: restarting {', '.join(names)}")
            self._client.restart(different, self._arguments)


def _named(paths: "Sequence[Path]") -> str:
    first = paths[0].name
    return f"{first} changed" if len(paths) == 1 else f"{first} and others changed"
