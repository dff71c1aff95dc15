"""An entry under ``nodes:`` → a process: its command line, environment and files."""

from contextlib import chdir
from dataclasses import fields
from pathlib import Path
from typing import Any

from navette.errors import InvalidValueError
from navette.supervisor.commands import command_line, read_words
from navette.supervisor.entry import Entry, EntryError, under
from navette.supervisor.specs import POLICIES, ProcessSpec, RestartPolicy
from navette.supervisor.variables import Variables


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
    with chdir(folder), under(entry.kind):
        said = read_words(entry, variables)
        words, files = command_line(entry, said, variables)
    with under("restart"):
        restart = _restart(entry.get("restart"))
    spec = ProcessSpec(
        module=entry.module,
        name=_name(entry, said, taken),
        words=tuple(words),
        cwd=str(folder),
        env={"PYTHONUNBUFFERED": "1", **_environment(entry, variables)},
        shell=bool(entry.own.get("shell", False)),
        tells_ready=entry.kind == "run",
        stop_timeout_s=_seconds(entry, "stop_timeout_s", 5.0),
        restart=restart,
    )
    return spec, [str(folder / file) for file in files]


def _name(entry: Entry, said: list[str], taken: set[str]) -> str:
    """What it is called: as given, or after what it runs; unique in its module."""
    given = entry.own.get("name")
    base = str(given) if given else _base_name(entry.kind, said)
    if given and base in taken:
        raise EntryError("name", f"two processes are named {base!r}")
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
    with under("environment"):
        for given in entry.all_of("environment"):
            if not isinstance(given, dict):
                raise InvalidValueError(
                    f"environment: {given!r}: wanted names and values"
                )
            for name, value in given.items():
                text = str(value).lower() if isinstance(value, bool) else str(value)
                found[str(name)] = variables.fill(text)
    return found


def _seconds(entry: Entry, key: str, default: float) -> float:
    value = entry.get(key)
    if value is None:
        return default
    if isinstance(value, bool) or not isinstance(value, (int, float)) or value < 0:
        raise EntryError(key, f"{key}: {value!r}: wanted seconds, 0 or more")
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
