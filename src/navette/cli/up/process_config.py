"""Process spec of an entry: name, command line, environment, restart policy."""

from contextlib import chdir
from dataclasses import fields
from pathlib import Path
from typing import Any

from navette.cli.up.command_lines import command_line, read_words
from navette.cli.up.entry import EntryError, ServiceEntry, errors_under
from navette.cli.up.variables import Variables
from navette.errors import InvalidValueError
from navette.supervisor.service_config import (
    RESTART_CONDITIONS,
    ProcessConfig,
    RestartPolicy,
)


def read_process(
    entry: ServiceEntry, variables: Variables, folder: Path, names_in_use: set[str]
) -> tuple[ProcessConfig, list[str]]:
    """Return the process and the files whose change requires a restart.

    Args:
        folder: working directory of the process; its paths are relative to it.
        names_in_use: names of the service's other processes; the new one is added.

    Raises:
        NavetteError: an invalid value; describes what is expected.
    """
    with chdir(folder), errors_under(entry.kind):
        words = read_words(entry, variables)
        argv, files = command_line(entry, words, variables)
    with errors_under("restart"):
        restart = _restart_policy(entry.get("restart"))
    spec = ProcessConfig(
        service=entry.service,
        name=_unique_name(entry, words, names_in_use),
        argv=tuple(argv),
        cwd=str(folder),
        env={"PYTHONUNBUFFERED": "1", **_environment(entry, variables)},
        shell=bool(entry.own.get("shell", False)),
        reports_ready=entry.kind == "run",
        stop_timeout_s=_seconds(entry, "stop_timeout_s", 5.0),
        restart=restart,
    )
    return spec, [str(folder / file) for file in files]


def _unique_name(entry: ServiceEntry, words: list[str], names_in_use: set[str]) -> str:
    given = entry.own.get("name")
    base = str(given) if given else _default_name(entry.kind, words)
    if given and base in names_in_use:
        raise EntryError("name", f"duplicate process name {base!r}")
    name, number = base, 1
    while name in names_in_use:
        number += 1
        name = f"{base}-{number}"
    names_in_use.add(name)
    return name


def _default_name(kind: str, words: list[str]) -> str:
    """Return the executable, class or file name, without package and suffix."""
    words = [word for word in words if ":=" not in word]
    if kind == "run" and len(words) > 1 and not words[1].startswith("-"):
        is_file = words[0].endswith(".py") or ":" in words[0]
        return words[0 if is_file else 1].rpartition(":")[2].removesuffix(".py")
    last = words[1] if kind == "launch" and len(words) > 1 else words[0]
    return Path(last.rpartition(":")[2] or last).name.partition(".")[0]


def _environment(entry: ServiceEntry, variables: Variables) -> dict[str, str]:
    found: dict[str, str] = {}
    with errors_under("environment"):
        for given in entry.all_of("environment"):
            if not isinstance(given, dict):
                raise InvalidValueError(f"environment: {given!r}: expected a mapping")
            for name, value in given.items():
                text = str(value).lower() if isinstance(value, bool) else str(value)
                found[str(name)] = variables.expand(text)
    return found


def _seconds(entry: ServiceEntry, key: str, default: float) -> float:
    value = entry.get(key)
    if value is None:
        return default
    if not _is_non_negative(value):
        raise EntryError(key, f"{key}: {value!r}: expected seconds, 0 or more")
    return float(value)


def _restart_policy(given: Any) -> RestartPolicy:
    """Read a condition, or a mapping with the fields of :class:`RestartPolicy`."""
    if given is None:
        return RestartPolicy()
    values = dict(given) if isinstance(given, dict) else {"condition": given}
    known = [each.name for each in fields(RestartPolicy)]
    for key, value in values.items():
        if key not in known:
            raise InvalidValueError(
                f"restart: unknown key {key!r} (known: {', '.join(known)})"
            )
        if key != "condition" and not _is_non_negative(value):
            raise InvalidValueError(f"restart: {key}: {value!r}: expected 0 or more")
    if values.get("condition") is False:  # YAML reads a bare `no` as false
        values["condition"] = "no"
    if values.get("condition", "no") not in RESTART_CONDITIONS:
        raise InvalidValueError(
            f"restart: {values['condition']!r}: expected one of "
            f"{', '.join(RESTART_CONDITIONS)}"
        )
    return RestartPolicy(**values)


def _is_non_negative(value: Any) -> bool:
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return is_number and value >= 0
