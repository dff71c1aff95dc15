"""``navette.yaml``: read, checked, and worked out into module specs."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import yaml

from navette.errors import FileFormatError, InvalidValueError, NavetteError
from navette.modules.entries import Entry, read_process
from navette.modules.project import Project
from navette.modules.specs import ModuleSpec
from navette.modules.variables import Variables
from navette.runtime.parameter_files import RosLoader

DEFAULT_FILE = Path(__file__).parent / "default.yaml"
_TOP_KEYS = ("arguments", "modules")
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
_MOST_BYTES = 1 << 20


@dataclass(frozen=True)
class ProjectFile:
    """The file of a project, with its arguments worked out.

    Attributes:
        arguments: those that were given, now or before.
    """

    path: Path
    modules: Mapping[str, Mapping[str, Any]]
    variables: Variables
    folder: Path
    arguments: Mapping[str, str]

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
            raise self._error(f"modules that need one another: {chain}")
        if name not in self.modules:
            where = f"module {path[-1]!r} needs {name!r}, but" if path else ""
            raise InvalidValueError(
                f"{where or f'{name!r}:'} {self.path} has no such module"
                f"{_meant(name, self.names)} (modules: {', '.join(self.names)})"
            )
        for need in self._needs(name):
            self._add(need, order, (*path, name))
        order[name] = None

    def _needs(self, name: str) -> tuple[str, ...]:
        needs = self.modules[name].get("needs") or []
        return tuple(str(each) for each in self._list(name, "needs", needs))

    def _spec(self, name: str) -> ModuleSpec:
        module = self.modules[name]
        _check_keys(self.path, f"module {name!r}", module, _MODULE_KEYS)
        shared = {
            key: value
            for key, value in module.items()
            if key not in ("needs", "nodes", "watch")
        }
        taken: set[str] = set()
        processes = []
        watched: dict[str, None] = {}
        for entry in self._list(name, "nodes", module.get("nodes") or []):
            if not entry:
                raise self._error(f"module {name!r}: an empty entry in 'nodes'")
            try:
                made, files = read_process(
                    Entry.of(name, entry, shared), self.variables, self.folder, taken
                )
            except NavetteError as error:
                raise self._error(f"module {name!r}: {error}") from error
            processes.append(made)
            watched.update(dict.fromkeys(files))
        if not processes:
            raise self._error(
                f"module {name!r}: wanted 'nodes', a list of at least one"
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

    def _list(self, module: str, key: str, value: Any) -> list[Any]:
        if not isinstance(value, list):
            raise self._error(f"module {module!r}: {key}: {value!r}: wanted a list")
        return value

    def _error(self, reason: str) -> FileFormatError:
        return FileFormatError(self.path, reason)


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
    path = project.file or DEFAULT_FILE
    content = _load(path)
    _check_keys(path, "the file", content, _TOP_KEYS)
    modules = content.get("modules")
    if not isinstance(modules, dict) or not modules:
        raise FileFormatError(path, "wanted 'modules:' with a name and a mapping each")
    for name, module in modules.items():
        if not isinstance(module, dict):
            raise FileFormatError(path, f"module {name!r}: wanted a mapping")
        if not str(name).replace("-", "_").isidentifier():
            raise FileFormatError(
                path, f"module name {name!r}: wanted letters, digits, - and _"
            )
    declared = content.get("arguments") or {}
    if not isinstance(declared, dict):
        raise FileFormatError(path, "arguments: wanted names with a default each")
    values = {str(name): _as_text(value) for name, value in declared.items()}
    for name in arguments:
        if name not in values:
            raise InvalidValueError(
                f"{path} has no argument {name!r}{_meant(name, list(values))} "
                f"(arguments: {', '.join(values) or 'none'})"
            )
    named = {str(name): module for name, module in modules.items()}
    kept = {name: text for name, text in (before or {}).items() if name in values}
    given = {**kept, **arguments}
    variables = Variables({**values, **given}, path)
    return ProjectFile(path, named, variables, project.folder, given)


def _load(path: Path) -> dict[Any, Any]:
    data = path.read_bytes()
    if len(data) > _MOST_BYTES:
        raise FileFormatError(path, f"larger than {_MOST_BYTES} bytes")
    try:
        for event in yaml.parse(data, Loader=RosLoader):
            if isinstance(event, yaml.AliasEvent):  # a few make very much of a little
                raise FileFormatError(
                    path, f"YAML alias *{event.anchor}: not read here"
                )
        content = yaml.load(data, Loader=RosLoader)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        reason = getattr(error, "problem", None) or str(error)
        line = None if mark is None else mark.line + 1
        raise FileFormatError(path, f"not YAML: {reason}", line) from None
    except RecursionError:
        raise FileFormatError(path, "nested too deep") from None
    if not isinstance(content, dict):
        raise FileFormatError(path, "wanted 'modules:' with a name and a mapping each")
    return content


def _check_keys(
    path: Path, where: str, given: Mapping[Any, Any], known: tuple[str, ...]
) -> None:
    for key in given:
        if key not in known:
            raise FileFormatError(
                path,
                f"{where}: unknown key {key!r}{_meant(str(key), list(known))} "
                f"(known: {', '.join(known)})",
            )


def _meant(name: str, known: list[str]) -> str:
    close = get_close_matches(name, known, n=1)
    return f"; did you mean {close[0]!r}?" if close else ""


def _as_text(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return "" if value is None else str(value)
