"""What an entry starts → its command line, and the files behind it."""

import shlex
import shutil
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from navette.errors import InvalidValueError, ParameterError
from navette.ros2.launch.session import find_launch_file
from navette.ros2.names.targets import find_sources, read_programs
from navette.ros2.packages.launch_ros.node_arguments import ros_arguments
from navette.runtime.names import RemapRule
from navette.runtime.parameter_files import read_parameter_file
from navette.supervisor.entry import Entry, under
from navette.supervisor.variables import Variables


def read_words(entry: Entry, variables: Variables) -> list[str]:
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
    with under("arguments"):
        if not isinstance(extra, list):
            raise InvalidValueError(f"arguments: {extra!r}: wanted a list")
        more = [variables.fill(str(word)) for word in extra]
    if not words:
        raise InvalidValueError(f"{entry.kind}: it is empty")
    return words + more


def navette_words(*words: str) -> list[str]:
    """The command line of a ``navette`` command in a process of its own."""
    return [sys.executable, "-u", "-m", "navette", *words]


def command_line(
    entry: Entry, said: list[str], variables: Variables
) -> tuple[list[str], list[Path]]:
    """The whole command line of what the entry says, and the files that it reads."""
    make = {"run": _run, "launch": _launch, "command": _command}[entry.kind]
    return make(entry, said, variables)


def _run(
    entry: Entry, said: list[str], variables: Variables
) -> tuple[list[str], list[Path]]:
    read_programs(said)
    items: list[Any] = _parameter_files(entry, variables)
    files = [*find_sources(said), *items]
    with under("parameters"):
        for values in entry.all_of("parameters"):
            if not isinstance(values, dict):
                raise ParameterError(f"parameters: {values!r}: wanted names and values")
            items += _flat(variables.fill_value(values))
    name = entry.own.get("node_name")
    namespace = variables.fill(str(entry.own.get("namespace") or ""))
    rules = _remaps(entry, variables)
    ros = ros_arguments(None if name is None else str(name), namespace, items, rules)
    return navette_words("run", *said, *(["--ros-args", *ros] if ros else [])), files


def _parameter_files(entry: Entry, variables: Variables) -> list[Path]:
    found = []
    with under("parameter_files"):
        for given in entry.all_of("parameter_files"):
            for path in given if isinstance(given, list) else [given]:
                file = Path(variables.fill(str(path))).expanduser()
                read_parameter_file(file)
                found.append(file.resolve())
    return found


def _remaps(entry: Entry, variables: Variables) -> list[tuple[str, str]]:
    remaps = entry.own.get("remap") or {}
    with under("remap"):
        if not isinstance(remaps, dict):
            raise InvalidValueError(f"remap: {remaps!r}: wanted names and new names")
        rules = [(str(old), variables.fill(str(new))) for old, new in remaps.items()]
        for old, new in rules:
            RemapRule.parse(f"{old}:={new}")
    return rules


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
