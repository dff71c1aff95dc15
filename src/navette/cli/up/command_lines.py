"""Command line of an entry, and the files that it reads."""

import shlex
import shutil
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from navette.cli.up.entry import ServiceEntry, errors_under
from navette.cli.up.variables import Variables
from navette.errors import InvalidValueError, ParameterError
from navette.ros2.launch.session import find_launch_file
from navette.ros2.names.targets import find_sources, read_programs
from navette.runtime.names import RemapRule
from navette.runtime.parameter_files import format_value, read_parameter_file

CommandLine = tuple[list[str], list[Path]]
"""The words, and the files that the program reads."""


def read_words(entry: ServiceEntry, variables: Variables) -> list[str]:
    """Return the words of the entry's command, with its ``arguments`` appended."""
    given = entry.own[entry.kind]
    if isinstance(given, str):
        try:
            words = shlex.split(variables.expand(given))
        except ValueError as error:
            raise InvalidValueError(f"{given!r}: {error}") from None
    elif isinstance(given, list) and given:
        words = [variables.expand(str(word)) for word in given]
    else:
        raise InvalidValueError(
            f"{entry.kind}: {given!r}: expected a string or a list of words"
        )
    if not words:
        raise InvalidValueError(f"{entry.kind}: empty command")
    with errors_under("arguments"):
        arguments = entry.own.get("arguments") or []
        if not isinstance(arguments, list):
            raise InvalidValueError(f"arguments: {arguments!r}: expected a list")
        return words + [variables.expand(str(word)) for word in arguments]


def command_line(
    entry: ServiceEntry, words: list[str], variables: Variables
) -> CommandLine:
    """Resolve the words of an entry into the command line of a process."""
    if entry.kind == "run":
        return _run(entry, words, variables)
    if entry.kind == "launch":
        path, _ = find_launch_file(words)
        options = ["--processes"] if entry.own.get("processes") else []
        return _navette("launch", *options, *words), [path]
    if not entry.own.get("shell") and shutil.which(words[0]) is None:
        raise InvalidValueError(f"command {words[0]!r}: no such program")
    return words, []


def _navette(*words: str) -> list[str]:
    return [sys.executable, "-u", "-m", "navette", *words]


def _run(entry: ServiceEntry, words: list[str], variables: Variables) -> CommandLine:
    read_programs(words)
    parameters: list[Any] = _parameter_files(entry, variables)
    files = [*find_sources(words), *parameters]
    with errors_under("parameters"):
        for values in entry.all_of("parameters"):
            if not isinstance(values, dict):
                raise ParameterError(f"parameters: {values!r}: expected a mapping")
            parameters += _flat(variables.expand_value(values))
    name = entry.own.get("node_name")
    ros = _ros_arguments(
        None if name is None else str(name),
        variables.expand(str(entry.own.get("namespace") or "")),
        parameters,
        _remaps(entry, variables),
    )
    return _navette("run", *words, *(["--ros-args", *ros] if ros else [])), files


def _ros_arguments(
    name: str | None,
    namespace: str,
    parameters: Iterable[Path | tuple[str, Any]],
    remaps: Iterable[tuple[str, str]],
) -> list[str]:
    """Return the words after ``--ros-args``."""
    words: list[str] = []
    if name is not None:
        words += ["-r", f"__node:={name}"]
    if namespace:
        words += ["-r", f"__ns:={namespace}"]
    for item in parameters:
        if isinstance(item, Path):
            words += ["--params-file", str(item)]
        else:
            words += ["-p", f"{item[0]}:={format_value(item[1])}"]
    for source, target in remaps:
        words += ["-r", f"{source}:={target}"]
    return words


def _parameter_files(entry: ServiceEntry, variables: Variables) -> list[Path]:
    found = []
    with errors_under("parameter_files"):
        for given in entry.all_of("parameter_files"):
            for path in given if isinstance(given, list) else [given]:
                file = Path(variables.expand(str(path))).expanduser()
                read_parameter_file(file)
                found.append(file.resolve())
    return found


def _remaps(entry: ServiceEntry, variables: Variables) -> list[tuple[str, str]]:
    with errors_under("remap"):
        remaps = entry.own.get("remap") or {}
        if not isinstance(remaps, dict):
            raise InvalidValueError(f"remap: {remaps!r}: expected a mapping of names")
        rules = [(str(old), variables.expand(str(new))) for old, new in remaps.items()]
        for old, new in rules:
            RemapRule.parse(f"{old}:={new}")
    return rules


def _flat(values: Mapping[str, Any], prefix: str = "") -> list[tuple[str, Any]]:
    found: list[tuple[str, Any]] = []
    for name, value in values.items():
        if isinstance(value, dict):
            found += _flat(value, f"{prefix}{name}.")
        else:
            found.append((f"{prefix}{name}", value))
    return found
