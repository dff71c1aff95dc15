"""Command-line arguments of ROS 2 programs: ``--ros-args -r … -p …``."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from navette.errors import InvalidValueError
from navette.runtime.exceptions import RosArgumentsError, UnknownROSArgsError
from navette.runtime.log_levels import LoggingSeverity, severity_from_string
from navette.runtime.names import RemapRule

ParameterArgument = tuple[str | None, str, object]
"""(node name or None, parameter name, value)."""


@dataclass
class RosArguments:
    """The arguments between ``--ros-args`` and ``--``, and the others."""

    remaps: list[RemapRule] = field(default_factory=list)
    #: Parameter files and single parameters; later ones take precedence.
    parameters: list[Path | ParameterArgument] = field(default_factory=list)
    #: (logger name or None for all, level)
    log_levels: list[tuple[str | None, LoggingSeverity]] = field(default_factory=list)
    log_file: Path | None = None
    #: Start of the name of a log file in the log directory.
    log_file_name: str | None = None
    enable_rosout: bool = True
    enable_stdout: bool = True
    enclave: str = "/"
    other: list[str] = field(default_factory=list)


_FLAGS = {
    "--enable-rosout-logs": ("enable_rosout", True),
    "--disable-rosout-logs": ("enable_rosout", False),
    "--enable-stdout-logs": ("enable_stdout", True),
    "--disable-stdout-logs": ("enable_stdout", False),
}
_PARAMETER_NAME = re.compile(r"[^\s:=]+")
_IGNORED_FLAGS = ("--enable-external-lib-logs", "--disable-external-lib-logs")
_WITH_VALUE = {
    "-r": "remap",
    "--remap": "remap",
    "-p": "parameter",
    "--param": "parameter",
    "--params-file": "file",
    "--log-level": "level",
    "--log-file": "log_file",
    "--log-file-name": "log_file_name",
    "-e": "enclave",
    "--enclave": "enclave",
}


def parse_ros_arguments(args: Sequence[str]) -> RosArguments:
    """Parse the ROS arguments in ``args``, with or without the program's name.

    Raises:
        UnknownROSArgsError: a ROS argument is unknown.
        RosArgumentsError: a ROS argument has the wrong form.
    """
    found = RosArguments()
    rest = iter(args)
    for argument in rest:
        if argument == "--ros-args":
            _parse_block(rest, found)
        else:
            found.other.append(argument)
    return found


def remove_ros_args(args: Sequence[str]) -> list[str]:
    """Return ``args`` without the blocks from ``--ros-args`` to ``--``."""
    kept: list[str] = []
    inside = False
    for argument in args:
        if argument == "--ros-args":
            inside = True
        elif inside and argument == "--":
            inside = False
        elif not inside:
            kept.append(argument)
    return kept


def _parse_block(rest: Iterator[str], found: RosArguments) -> None:
    for argument in rest:
        if argument == "--":
            return
        if argument == "--ros-args" or argument in _IGNORED_FLAGS:
            continue
        if argument in _FLAGS:
            name, value = _FLAGS[argument]
            setattr(found, name, value)
        elif argument in _WITH_VALUE:
            text = next(rest, None)
            if text is None:
                raise RosArgumentsError(
                    f"ROS argument {argument}: the value is missing"
                )
            _store(_WITH_VALUE[argument], text, found)
        elif ":=" in argument and not argument.startswith("-"):
            _store("remap", argument, found)
        else:
            known = sorted((*_WITH_VALUE, *_FLAGS, *_IGNORED_FLAGS))
            raise UnknownROSArgsError(
                f"unknown ROS argument {argument!r}; known: {', '.join(known)}"
            )


def _store(kind: str, text: str, found: RosArguments) -> None:
    try:
        _store_value(kind, text, found)
    except InvalidValueError as error:
        raise RosArgumentsError(str(error)) from error


def _store_value(kind: str, text: str, found: RosArguments) -> None:
    if kind == "remap":
        found.remaps.append(RemapRule.parse(text))
    elif kind == "parameter":
        found.parameters.append(parse_parameter_argument(text))
    elif kind == "file":
        found.parameters.append(Path(text))
    elif kind == "log_file":
        found.log_file = Path(text)
    elif kind == "log_file_name":
        if not re.fullmatch(r"[^/\0]+", text):
            raise InvalidValueError(
                f"log file name {text!r}: expected a name without /"
            )
        found.log_file_name = text
    elif kind == "enclave":
        found.enclave = _enclave(text)
    else:
        name, separator, level = text.rpartition(":=")
        found.log_levels.append(
            (name if separator else None, severity_from_string(level))
        )


def parse_parameter_argument(text: str) -> ParameterArgument:
    """Parse ``[node:]name:=value``."""
    left, separator, value = text.partition(":=")
    node, colon, name = left.rpartition(":")
    if not separator or not _PARAMETER_NAME.fullmatch(name):
        raise InvalidValueError(f"parameter {text!r}: expected [node:]name:=value")
    if not value:
        raise InvalidValueError(
            f"parameter {text!r}: the value is missing; an empty text is {left}:=''"
        )
    from navette.runtime.parameter_files import parse_value

    return (node if colon else None, name, parse_value(value))


def _enclave(text: str) -> str:
    if not re.fullmatch(r"/|(/[A-Za-z_]\w*)+", text, re.ASCII):
        raise InvalidValueError(
            f"enclave {text!r}: expected / or names of letters, digits and _, "
            "each after a /"
        )
    return text
