"""What a person typed after ``navette run`` → programs."""

from collections.abc import Sequence
from pathlib import Path

from navette.errors import InvalidValueError
from navette.interop.program import Program, entry_point, file_entry_point, script

WITH = "--with"
_FORMS = (
    "FILE.py [ARGS], MODULE:Class [ARGS], FILE.py:Class [ARGS] "
    "or PACKAGE EXECUTABLE [ARGS]"
)


def read_programs(words: Sequence[str]) -> list[Program]:
    """The programs, of which each but the first stands behind a ``--with``.

    Raises:
        InvalidValueError: a program is missing or has none of the forms.
        UnknownNameError: no such package or executable; lists those known.
    """
    groups: list[list[str]] = [[]]
    for word in words:
        if word == WITH:
            groups.append([])
        else:
            groups[-1].append(word)
    return [_read_program(group) for group in groups]


def _read_program(words: Sequence[str]) -> Program:
    if not words:
        raise InvalidValueError(f"a program is missing; wanted {_FORMS}")
    target, arguments = words[0], tuple(words[1:])
    place, colon, attribute = target.rpartition(":")
    if colon and attribute.isidentifier():
        if place.endswith(".py"):
            return file_entry_point(_existing(Path(place)), attribute, arguments)
        return entry_point(place, attribute, arguments)
    if target.endswith(".py") or Path(target).is_file():
        return script(_existing(Path(target)), arguments)
    raise InvalidValueError(f"{target!r} is no program; wanted {_FORMS}")


def _existing(path: Path) -> Path:
    if not path.is_file():
        raise InvalidValueError(f"{path}: no such file")
    return path
