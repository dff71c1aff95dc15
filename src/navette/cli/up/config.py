"""Read ``navette.yaml`` and resolve it into service specs."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from navette.cli.up.document import Document, Place, read_document
from navette.cli.up.entry import EntryError, ServiceEntry
from navette.cli.up.process_config import read_process
from navette.cli.up.variables import Variables
from navette.errors import FileFormatError, InvalidValueError, NavetteError
from navette.supervisor.project import FILE_NAME, Project
from navette.supervisor.service_config import ProcessConfig, ServiceConfig

DEFAULT_FILE = Path(__file__).parent / "default.yaml"
_TOP_KEYS = ("arguments", "environment", "services")
_SERVICE_KEYS = (
    "depends_on",
    "nodes",
    "parameters",
    "parameter_files",
    "environment",
    "restart",
    "stop_timeout_s",
    "watch",
)
_EXPECTED = "expected 'services:' with a mapping of names to services"


@dataclass(frozen=True)
class ProjectConfig:
    """The configuration file of a project, with values for its arguments.

    Attributes:
        arguments: the arguments given now or by an earlier command.
        shared: what all services inherit: ``environment``.
    """

    document: Document
    services: Mapping[str, Mapping[str, Any]]
    variables: Variables
    folder: Path
    arguments: Mapping[str, str]
    shared: Mapping[str, Any]

    @property
    def path(self) -> Path:
        return self.document.path

    @property
    def names(self) -> list[str]:
        return list(self.services)

    def specs(self, names: Iterable[str]) -> list[ServiceConfig]:
        """Return the named services and their dependencies, dependencies first.

        Raises:
            InvalidValueError: unknown service; lists the known ones.
            FileFormatError: an invalid service; names the line.
        """
        order: dict[str, None] = {}
        for name in names:
            self._add(name, order, ())
        return [self._spec(name) for name in order]

    def _add(self, name: str, order: dict[str, None], path: tuple[str, ...]) -> None:
        if name in path:
            cycle = " → ".join([*path[path.index(name) :], name])
            raise self._error(f"dependency cycle: {cycle}", path[-1], "depends_on")
        if name not in self.services:
            raise self._unknown_service(name, path)
        for dependency in self._depends_on(name):
            self._add(dependency, order, (*path, name))
        order[name] = None

    def _unknown_service(self, name: str, path: tuple[str, ...]) -> NavetteError:
        names, hint = ", ".join(self.names), did_you_mean(name, self.names)
        if path:
            return self._error(
                f"service {path[-1]!r} depends on unknown service {name!r}{hint} "
                f"(services: {names})",
                path[-1],
                "depends_on",
            )
        known = f"{self.path} has {names}"
        if self.path == DEFAULT_FILE:
            known = (
                f"no {FILE_NAME} in {self.folder} or above; the built-in services "
                f"are {names}"
            )
        return InvalidValueError(f"unknown service {name!r}{hint} ({known})")

    def _depends_on(self, name: str) -> tuple[str, ...]:
        return tuple(map(str, self._list(name, "depends_on")))

    def _spec(self, name: str) -> ServiceConfig:
        service = self.services[name]
        for key in service:
            if key not in _SERVICE_KEYS:
                reason = _unknown_key(key, _SERVICE_KEYS)
                raise self._error(f"service {name!r}: {reason}", name, key)
        names_in_use: set[str] = set()
        processes = []
        watched: dict[str, None] = {}
        for number, entry in enumerate(self._list(name, "nodes")):
            process, files = self._process(name, number, entry, names_in_use)
            processes.append(process)
            watched.update(dict.fromkeys(files))
        if not processes:
            reason = f"service {name!r}: expected 'nodes', a list of at least one entry"
            raise self._error(reason, name)
        for each in self._list(name, "watch"):
            watched[str(self.folder / self.variables.expand(str(each)))] = None
        return ServiceConfig(
            name=name,
            depends_on=self._depends_on(name),
            processes=tuple(processes),
            watched=tuple(watched),
        )

    def _process(
        self, name: str, number: int, entry: Any, names_in_use: set[str]
    ) -> tuple[ProcessConfig, list[str]]:
        """Return the process of an entry and the files that it reads."""
        try:
            if not entry:
                raise InvalidValueError("empty entry in 'nodes'")
            return read_process(
                ServiceEntry.of(name, entry, self.services[name], self.shared),
                self.variables,
                self.folder,
                names_in_use,
            )
        except NavetteError as error:
            key = error.key if isinstance(error, EntryError) else ""
            place = self._place(name, number, entry, key)
            reason = f"service {name!r}: {error}"
            raise self.document.error(reason, *place) from error

    def _place(self, name: str, number: int, entry: Any, key: str) -> Place:
        """Return where an entry's value of ``key`` comes from.

        The entry itself, its service, or the top of the file.
        """
        own: Place = ("services", name, "nodes", number, key)
        if isinstance(entry, dict) and key in entry:
            return own
        if key in self.services[name]:
            return ("services", name, key)
        return (key,) if key in self.shared else own

    def _list(self, service: str, key: str) -> list[Any]:
        value = self.services[service].get(key) or []
        if not isinstance(value, list):
            raise self._error(
                f"service {service!r}: {key}: {value!r}: expected a list", service, key
            )
        return value

    def _error(self, reason: str, *place: str | int) -> FileFormatError:
        return self.document.error(reason, "services", *place)


def read_config(
    project: Project,
    arguments: Mapping[str, str],
    previous: Mapping[str, str] | None = None,
) -> ProjectConfig:
    """Read the configuration file of a project, or the built-in one.

    Args:
        arguments: values for the file's ``arguments``.
        previous: values given by an earlier command; ``arguments`` override them, and
            names that the file no longer declares are ignored.

    Raises:
        FileFormatError: not YAML, or an invalid structure; names the line.
        InvalidValueError: an argument that the file does not declare.
    """
    document = read_document(project.file or DEFAULT_FILE, _EXPECTED)
    content = document.content
    for key in content:
        if key not in _TOP_KEYS:
            raise document.error(_unknown_key(key, _TOP_KEYS), key)
    services = _services(document)
    declared = content.get("arguments") or {}
    if not isinstance(declared, dict):
        reason = "arguments: expected a mapping of names to default values"
        raise document.error(reason, "arguments")
    defaults = {name: _as_text(value) for name, value in declared.items()}
    for name in arguments:
        if name not in defaults:
            hint, known = did_you_mean(name, list(defaults)), ", ".join(defaults)
            raise InvalidValueError(
                f"{document.path} declares no argument {name!r}{hint} "
                f"(arguments: {known or 'none'})"
            )
    kept = {name: text for name, text in (previous or {}).items() if name in defaults}
    given = {**kept, **arguments}
    return ProjectConfig(
        document=document,
        services=services,
        variables=Variables({**defaults, **given}, document.path),
        folder=project.folder,
        arguments=given,
        shared={key: content[key] for key in ("environment",) if key in content},
    )


def _services(document: Document) -> dict[str, Mapping[str, Any]]:
    services = document.content.get("services")
    if not isinstance(services, dict) or not services:
        raise document.error(_EXPECTED, "services")
    for name, service in services.items():
        if not isinstance(service, dict):
            reason = f"service {name!r}: expected a mapping with 'nodes'"
            raise document.error(reason, "services", name)
        if not name.replace("-", "_").isidentifier():
            reason = f"service name {name!r}: use only letters, digits, - and _"
            raise document.error(reason, "services", name)
    return services


def _unknown_key(key: str, known: tuple[str, ...]) -> str:
    hint = did_you_mean(key, list(known))
    return f"unknown key {key!r}{hint} (known: {', '.join(known)})"


def did_you_mean(name: str, known: list[str]) -> str:
    close = get_close_matches(name, known, n=1)
    return f"; did you mean {close[0]!r}?" if close else ""


def _as_text(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return "" if value is None else str(value)
