"""``navette.yaml``: read, checked, and worked out into module specs."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from navette.errors import FileFormatError, InvalidValueError, NavetteError
from navette.supervisor.document import Document, Place, read_document
from navette.supervisor.entries import read_process
from navette.supervisor.entry import Entry, EntryError
from navette.supervisor.project import FILE_NAME, Project
from navette.supervisor.specs import ModuleSpec, ProcessSpec
from navette.supervisor.variables import Variables

DEFAULT_FILE = Path(__file__).parent / "default.yaml"
_TOP_KEYS = ("arguments", "environment", "modules")
_MODULE_KEYS = (
    "needs",
    "nodes",
    "parameters",
    "parameter_files",
    "environment",
    "restart",
    "stop_timeout_s",
    "watch",
)
_FORM = "wanted 'modules:' with a name and a mapping each"


@dataclass(frozen=True)
class ProjectFile:
    """The file of a project, with its arguments worked out.

    Attributes:
        arguments: those that were given, now or before.
        shared: what all modules have: ``environment``.
    """

    document: Document
    modules: Mapping[str, Mapping[str, Any]]
    variables: Variables
    folder: Path
    arguments: Mapping[str, str]
    shared: Mapping[str, Any]

    @property
    def path(self) -> Path:
        return self.document.path

    @property
    def names(self) -> list[str]:
        return list(self.modules)

    def specs(self, names: Iterable[str]) -> list[ModuleSpec]:
        """The modules of these names and those that they need, these first.

        Raises:
            InvalidValueError: no module of a name; lists those there are.
            FileFormatError: something in one of them is wrong; says where.
        """
        order: dict[str, None] = {}
        for name in names:
            self._add(name, order, ())
        return [self._spec(name) for name in order]

    def _add(self, name: str, order: dict[str, None], path: tuple[str, ...]) -> None:
        if name in path:
            chain = " → ".join([*path[path.index(name) :], name])
            raise self._error(
                f"modules that need one another: {chain}", path[-1], "needs"
            )
        if name not in self.modules:
            names, meant = ", ".join(self.names), _meant(name, self.names)
            if path:
                reason = (
                    f"module {path[-1]!r} needs {name!r}, which is not there{meant}"
                )
                raise self._error(f"{reason} (modules: {names})", path[-1], "needs")
            where = f"{self.path} has {names}"
            if self.path == DEFAULT_FILE:
                where = (
                    f"no {FILE_NAME} in {self.folder} or above; built in are {names}"
                )
            raise InvalidValueError(f"no module {name!r}{meant} ({where})")
        for need in self._needs(name):
            self._add(need, order, (*path, name))
        order[name] = None

    def _needs(self, name: str) -> tuple[str, ...]:
        needs = self.modules[name].get("needs") or []
        return tuple(str(each) for each in self._list(name, "needs", needs))

    def _spec(self, name: str) -> ModuleSpec:
        module = self.modules[name]
        for key in module:
            if key not in _MODULE_KEYS:
                raise self._error(
                    f"module {name!r}: {_unknown(key, _MODULE_KEYS)}", name, key
                )
        taken: set[str] = set()
        processes = []
        watched: dict[str, None] = {}
        entries = self._list(name, "nodes", module.get("nodes") or [])
        for number, entry in enumerate(entries):
            made, files = self._process(name, number, entry, taken)
            processes.append(made)
            watched.update(dict.fromkeys(files))
        if not processes:
            raise self._error(
                f"module {name!r}: wanted 'nodes', a list of at least one", name
            )
        extra = self._list(name, "watch", module.get("watch") or [])
        for each in extra:
            watched[str(self.folder / self.variables.fill(str(each)))] = None
        return ModuleSpec(
            name=name,
            needs=self._needs(name),
            processes=tuple(processes),
            watched=tuple(watched),
        )

    def _process(
        self, name: str, number: int, entry: Any, taken: set[str]
    ) -> tuple[ProcessSpec, list[str]]:
        """The process of an entry of a module, and its files."""
        module = self.modules[name]
        try:
            if not entry:
                raise InvalidValueError("an empty entry in 'nodes'")
            return read_process(
                Entry.of(name, entry, module, self.shared),
                self.variables,
                self.folder,
                taken,
            )
        except NavetteError as error:
            reason = f"module {name!r}: {error}"
            key = error.key if isinstance(error, EntryError) else ""
            place = self._place(name, number, entry, key)
            raise self.document.error(reason, *place) from error

    def _place(self, name: str, number: int, entry: Any, key: str) -> Place:
        """Where a key stands that counts for an entry: there, at its module, on top."""
        own: Place = ("modules", name, "nodes", number, key)
        if isinstance(entry, dict) and key in entry:
            return own
        if key in self.modules[name]:
            return ("modules", name, key)
        return (key,) if key in self.shared else own

    def _list(self, module: str, key: str, value: Any) -> list[Any]:
        if not isinstance(value, list):
            raise self._error(
                f"module {module!r}: {key}: {value!r}: wanted a list", module, key
            )
        return value

    def _error(self, reason: str, *place: str | int) -> FileFormatError:
        return self.document.error(reason, "modules", *place)


def read_project(
    project: Project,
    arguments: Mapping[str, str],
    before: Mapping[str, str] | None = None,
) -> ProjectFile:
    """Read the project's file, or the built-in one.

    Args:
        arguments: values for what the file lists under ``arguments``.
        before: values of before, for what is not among these and the file still has.

    Raises:
        FileFormatError: not YAML, or not of this form; says where and what is wanted.
        InvalidValueError: an argument that the file has not got.
    """
    document = read_document(project.file or DEFAULT_FILE, _FORM)
    content = document.content
    for key in content:
        if key not in _TOP_KEYS:
            raise document.error(_unknown(key, _TOP_KEYS), key)
    modules = _modules(document)
    declared = content.get("arguments") or {}
    if not isinstance(declared, dict):
        raise document.error("arguments: wanted names with a default each", "arguments")
    values = {name: _as_text(value) for name, value in declared.items()}
    for name in arguments:
        if name not in values:
            raise InvalidValueError(
                f"{document.path} has no argument {name!r}{_meant(name, list(values))} "
                f"(arguments: {', '.join(values) or 'none'})"
            )
    kept = {name: text for name, text in (before or {}).items() if name in values}
    given = {**kept, **arguments}
    shared = {key: content[key] for key in ("environment",) if key in content}
    return ProjectFile(
        document=document,
        modules=modules,
        variables=Variables({**values, **given}, document.path),
        folder=project.folder,
        arguments=given,
        shared=shared,
    )


def _modules(document: Document) -> dict[str, Mapping[str, Any]]:
    """The modules by their names."""
    modules = document.content.get("modules")
    if not isinstance(modules, dict) or not modules:
        raise document.error(_FORM, "modules")
    for name, module in modules.items():
        if not isinstance(module, dict):
            raise document.error(
                f"module {name!r}: wanted a mapping with 'nodes'", "modules", name
            )
        if not name.replace("-", "_").isidentifier():
            raise document.error(
                f"module name {name!r}: wanted letters, digits, - and _",
                *("modules", name),
            )
    return modules


def _unknown(key: str, known: tuple[str, ...]) -> str:
    return f"unknown key {key!r}{_meant(key, list(known))} (known: {', '.join(known)})"


def _meant(name: str, known: list[str]) -> str:
    close = get_close_matches(name, known, n=1)
    return f"; did you mean {close[0]!r}?" if close else ""


def _as_text(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return "" if value is None else str(value)
