"""Launch arguments as typed: read, checked against the file, listed."""

from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from typing import Any

from navette.errors import InvalidValueError
from navette.ros2.packages.launch import LaunchDescription, LaunchDescriptionEntity
from navette.ros2.packages.launch.actions import (
    ForEach,
    ForLoop,
    IncludeLaunchDescription,
    OpaqueFunction,
)
from navette.ros2.packages.launch.launch_description import walk


def parse_launch_arguments(words: Iterable[str]) -> dict[str, str]:
    """``name:=value`` words → a dict.

    Raises:
        InvalidValueError: another form, or a name given twice.
    """
    found: dict[str, str] = {}
    for word in words:
        name, separator, value = word.partition(":=")
        if not separator or not name:
            raise InvalidValueError(f"launch argument {word!r}: wanted name:=value")
        if name in found:
            raise InvalidValueError(f"launch argument {name!r} is given twice")
        found[name] = value
    return found


# What ROS 2's actions look up without anybody declaring it.
ALWAYS_KNOWN = ("launch-prefix", "sigterm_timeout", "sigkill_timeout", "log_level")


def unknown_arguments(given: Iterable[str], known: Iterable[str]) -> list[str]:
    """The given names that nobody knows."""
    names = {*known, *ALWAYS_KNOWN}
    return [name for name in given if name not in names]


def unknown_argument_error(name: str, known: Sequence[str]) -> InvalidValueError:
    """Says what there is, and what was probably meant."""
    close = get_close_matches(name, known, n=1)
    meant = f"; did you mean {close[0]!r}?" if close else ""
    listed = ", ".join(known) or "none"
    return InvalidValueError(
        f"the launch file has no argument {name!r}{meant} (arguments: {listed})"
    )


def is_complete(description: LaunchDescription) -> bool:
    """Whether every declaration can be known before the launch runs."""
    return not any(_may_declare(entity) for entity in walk(description))


def _may_declare(entity: LaunchDescriptionEntity) -> bool:
    if isinstance(entity, IncludeLaunchDescription):
        return not entity.describe_sub_entities()
    return isinstance(entity, (ForEach, ForLoop, OpaqueFunction))


def describe_arguments(declared: Sequence[Any]) -> str:
    """As ``ros2 launch --show-args`` prints them."""
    lines = ["Arguments (pass arguments as '<name>:=<value>'):", ""]
    if not declared:
        lines += ["  No arguments.", ""]
    for argument in declared:
        lines.append(f"    '{argument.name}':")
        text = argument.description or "no description given"
        if argument.choices is not None:
            text += f". Valid choices are: {argument.choices}"
        lines.append(f"        {text}")
        if argument.default_value is not None:
            lines.append(f"        (default: {argument.describe_default()})")
        lines.append("")
    return "\n".join(lines)
