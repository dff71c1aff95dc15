"""An entry under ``nodes:`` → a process: its command line, environment and files."""

import shlex
import shutil
import sys
from collections.abc import Mapping
from contextlib import chdir
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from navette.bringup.session import find_launch_file
from navette.errors import InvalidValueError, ParameterError
from navette.interop.targets import find_sources, read_programs
from navette.launch_files.launch_ros.node_arguments import ros_arguments
from navette.modules.specs import POLICIES, ProcessSpec, RestartPolicy
from navette.modules.variables import Variables
from navette.runtime.names import RemapRule
from navette.runtime.parameter_files import read_parameter_file

_KINDS = ("run", "launch", "command")
_ONLY_RUN = ("parameters", "parameter_files", "remap", "namespace", "node_name")
_KEYS = (
    *_KINDS,
    "name",
    "node_name",
    "namespace",
    "arguments",
    "parameters",
    "parameter_files",
    "remap",
    "environment",
    "restart",
    "stop_timeout_s",
    "processes",
    "shell",
)


@dataclass(frozen=True)
class Entry:
    """What the file says of a process.

    ``own``: in its entry; ``shared``: in its module, for all of them.
    """

    module: str
    own: Mapping[str, Any]
    shared: Mapping[str, Any]

    @classmethod
    def of(cls, module: str, entry: Any, shared: Mapping[str, Any]) -> "Entry":
        """A text is what stands behind ``navette run``.

        Raises:
            InvalidValueError: neither text nor mapping, an unknown key, or not exactly
                one of run, launch and command.
        """
        own = {"run": entry} if isinstance(entry, str) else entry
        if not isinstance(own, dict):
            raise InvalidValueError(
                f"{entry!r}: wanted what stands behind 'navette run', or a mapping"
            )
        for key in own:
            if key not in _KEYS:
                raise InvalidValueError(
                    f"unknown key {key!r} (known: {', '.join(_KEYS)})"
                )
        kinds = [kind for kind in _KINDS if kind in own]
        if len(kinds) != 1:
            raise InvalidValueError(
                f"an entry has {' and '.join(kinds) or 'nothing to start'}; "
                f"wanted one of {', '.join(_KINDS)}"
            )
        for key in _ONLY_RUN if kinds != ["run"] else ():
            if key in own:
                raise InvalidValueError(f"{key} goes with 'run', not with {kinds[0]!r}")
        return cls(module, own, shared)

    @property
    def kind(self) -> str:
        return next(kind for kind in _KINDS if kind in self.own)

    def get(self, key: str) -> Any:
        """The entry's own value, or the module's."""
        return self.own.get(key, self.shared.get(key))

    def both(self, key: str) -> list[Any]:
        """The module's value and the entry's own, where given; the last wins."""
        return [each[key] for each in (self.shared, self.own) if each.get(key)]


def read_process(
    entry: Entry, variables: Variables, folder: Path, taken: set[str]
) -> tuple[ProcessSpec, list[str]]:
    """The process, and the files whose change should restart it.

    Args:
        folder: where it runs, and what its paths are relative to.
        taken: names that other processes of the module have; its own is added.

    Raises:
        NavetteError: something in it is wrong; says what is wanted.
    """
    said = _words(entry, variables)
    make = {"run": _run, "launch": _launch, "command": _command}[entry.kind]
    with chdir(folder):
        words, files = make(entry, said, variables)
    spec = ProcessSpec(
        module=entry.module,
        name=_name(entry, said, taken),
        words=tuple(words),
        cwd=str(folder),
        env={"PYTHONUNBUFFERED": "1", **_environment(entry, variables)},
        shell=bool(entry.own.get("shell", False)),
        tells_ready=entry.kind == "run",
        stop_timeout_s=_seconds(entry, "stop_timeout_s", 5.0),
        restart=_restart(entry.get("restart")),
    )
    return spec, [str(folder / file) for file in files]


def _words(entry: Entry, variables: Variables) -> list[str]:
    """The command line of the entry, with its ``arguments`` behind it."""
    said = entry.own[entry.kind]
    if isinstance(said, str):
        try:
            words = shlex.split(variables.fill(said))
        except ValueError as error:
            raise InvalidValueError(f"{said!r}: {error}") from None
    elif isinstance(said, list) and said:
        words = [variables.fill(str(word)) for word in said]
    else:
        raise InvalidValueError(f"{entry.kind}: {said!r}: wanted a text or a list")
    extra = entry.own.get("arguments") or []
    if not isinstance(extra, list):
        raise InvalidValueError(f"arguments: {extra!r}: wanted a list")
    if not words:
        raise InvalidValueError(f"{entry.kind}: it is empty")
    return words + [variables.fill(str(word)) for word in extra]


def navette_words(*words: str) -> list[str]:
    """The command line of a ``navette`` command in a process of its own."""
    return [sys.executable, "-u", "-m", "navette", *words]


def _run(
    entry: Entry, said: list[str], variables: Variables
) -> tuple[list[str], list[Path]]:
    read_programs(said)
    files = find_sources(said)
    items: list[Any] = []
    for given in entry.both("parameter_files"):
        for path in given if isinstance(given, list) else [given]:
            file = Path(variables.fill(str(path))).expanduser()
            read_parameter_file(file)
            items.append(file.resolve())
    files += items
    for values in entry.both("parameters"):
        if not isinstance(values, dict):
            raise ParameterError(f"parameters: {values!r}: wanted names and values")
        items += _flat(variables.fill_value(values))
    remaps = entry.own.get("remap") or {}
    if not isinstance(remaps, dict):
        raise InvalidValueError(f"remap: {remaps!r}: wanted names and new names")
    rules = [(str(old), variables.fill(str(new))) for old, new in remaps.items()]
    for old, new in rules:
        RemapRule.parse(f"{old}:={new}")
    name = entry.own.get("node_name")
    namespace = variables.fill(str(entry.own.get("namespace") or ""))
    ros = ros_arguments(None if name is None else str(name), namespace, items, rules)
    return navette_words("run", *said, *(["--ros-args", *ros] if ros else [])), files


def _launch(
    entry: Entry, said: list[str], variables: Variables
) -> tuple[list[str], list[Path]]:
    path, _ = find_launch_file(said)
    options = ["--processes"] if entry.own.get("processes") else []
    return navette_words("launch", *options, *said), [path]


def _command(
    entry: Entry, said: list[str], variables: Variables
) -> tuple[list[str], list[Path]]:
    if not entry.own.get("shell") and shutil.which(said[0]) is None:
        raise InvalidValueError(f"command {said[0]!r}: no such program")
    return said, []


def _flat(values: Mapping[str, Any], prefix: str = "") -> list[tuple[str, Any]]:
    found: list[tuple[str, Any]] = []
    for name, value in values.items():
        if isinstance(value, dict):
            found += _flat(value, f"{prefix}{name}.")
        else:
            found.append((f"{prefix}{name}", value))
    return found


def _name(entry: Entry, said: list[str], taken: set[str]) -> str:
    """What it is called: as given, or after what it runs; unique in its module."""
    given = entry.own.get("name")
    base = str(given) if given else _base_name(entry.kind, said)
    if given and base in taken:
        raise InvalidValueError(f"two processes are named {base!r}")
    name, number = base, 1
    while name in taken:
        number += 1
        name = f"{base}-{number}"
    taken.add(name)
    return name


def _base_name(kind: str, said: list[str]) -> str:
    """The executable, the class or the file, without what is around it."""
    words = [word for word in said if ":=" not in word]
    if kind == "run" and len(words) > 1 and not words[1].startswith("-"):
        is_file = words[0].endswith(".py") or ":" in words[0]
        return words[0 if is_file else 1].rpartition(":")[2].removesuffix(".py")
    last = words[1] if kind == "launch" and len(words) > 1 else words[0]
    return Path(last.rpartition(":")[2] or last).name.partition(".")[0]


def _environment(entry: Entry, variables: Variables) -> dict[str, str]:
    found: dict[str, str] = {}
    for given in entry.both("environment"):
        if not isinstance(given, dict):
            raise InvalidValueError(f"environment: {given!r}: wanted names and values")
        for name, value in given.items():
            text = str(value).lower() if isinstance(value, bool) else str(value)
            found[str(name)] = variables.fill(text)
    return found


def _seconds(entry: Entry, key: str, default: float) -> float:
    value = entry.get(key)
    if value is None:
        return default
    if isinstance(value, bool) or not isinstance(value, (int, float)) or value < 0:
        raise InvalidValueError(f"{key}: {value!r}: wanted seconds, 0 or more")
    return float(value)


def _restart(given: Any) -> RestartPolicy:
    """``no``, ``on-failure``, ``always``; or a mapping of :class:`RestartPolicy`."""
    values = (
        given if isinstance(given, dict) else {} if given is None else {"when": given}
    )
    known = [each.name for each in fields(RestartPolicy)]
    for key, value in values.items():
        if key not in known:
            raise InvalidValueError(
                f"restart: unknown key {key!r} (known: {', '.join(known)})"
            )
        if key != "when" and (
            isinstance(value, bool) or not isinstance(value, (int, float)) or value < 0
        ):
            raise InvalidValueError(f"restart: {key}: {value!r}: wanted 0 or more")
    if values.get("when") is False:  # YAML reads no as that
        values = {**values, "when": "no"}
    if values.get("when", "no") not in POLICIES:
        raise InvalidValueError(
            f"restart: {values['when']!r}: wanted {', '.join(POLICIES)}"
        )
    return RestartPolicy(**values)
