"""Launch arguments of the command line: parse, check, list."""

from collections.abc import Iterable, Sequence

from navette.errors import InvalidValueError, instead_of
from navette.ros2.packages.launch import LaunchDescription, LaunchDescriptionEntity
from navette.ros2.packages.launch.actions import (
    ForEach,
    ForLoop,
    IncludeLaunchDescription,
    OpaqueFunction,
)
from navette.ros2.packages.launch.launch_description import walk


def parse_launch_arguments(words: Iterable[str]) -> dict[str, str]:
    """Parse ``name:=value`` words.

    Raises:
        InvalidValueError: a malformed word, or a duplicate name.
    """
    found: dict[str, str] = {}
    for word in words:
        name, separator, value = word.partition(":=")
        if not separator or not name:
            raise InvalidValueError(f"launch argument {word!r}: expected name:=value")
        if name in found:
            raise InvalidValueError(f"launch argument {name!r} is given twice")
        found[name] = value
    return found


# ROS 2's actions read these without a declaration.
ALWAYS_KNOWN = ("launch-prefix", "sigterm_timeout", "sigkill_timeout", "log_level")


def unknown_arguments(given: Iterable[str], known: Iterable[str]) -> list[str]:
    """Return the given names that are not declared."""
    names = {*known, *ALWAYS_KNOWN}
    return [name for name in given if name not in names]


def unknown_argument_error(name: str, known: Sequence[str]) -> InvalidValueError:
    """Create the error for an undeclared argument, with the closest name."""
    see_all = "navette launch FILE --show-args"
    return InvalidValueError(
        f"the launch file has no argument {name!r}"
        f"{instead_of(name, known, see_all=see_all)}"
    )


def is_complete(description: LaunchDescription) -> bool:
    """Return whether all declarations are found without running the launch."""
    return not any(_may_declare(entity) for entity in walk(description))


def _may_declare(entity: LaunchDescriptionEntity) -> bool:
    if isinstance(entity, IncludeLaunchDescription):
        return not entity.get_sub_entities()
    return isinstance(entity, (ForEach, ForLoop, OpaqueFunction))
