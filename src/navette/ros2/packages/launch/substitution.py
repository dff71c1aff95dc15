"""Substitutions: text that is worked out when the launch runs."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any, TypeAlias

from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext


class Substitution:
    """Something that becomes text once the launch runs."""

    def perform(self, context: LaunchContext) -> str:
        """The text, given the launch's configurations and environment."""
        raise NotImplementedError

    def describe(self) -> str:
        """How it reads in an error or a listing."""
        return f"{type(self).__name__}()"


SomeSubstitutionsType: TypeAlias = (
    str | Path | Substitution | Iterable[str | Path | Substitution]
)
SomeSubstitutionsType_types_tuple = (str, Path, Substitution, Iterable)
Parts: TypeAlias = list[Substitution]
"""Substitutions whose texts are joined."""


class TextSubstitution(Substitution):
    """Text that is what it is."""

    def __init__(self, *, text: str) -> None:
        if not isinstance(text, str):
            raise InvalidLaunchValueError(
                f"TextSubstitution: text {text!r}: wanted a string"
            )
        self.text = text

    def perform(self, context: LaunchContext) -> str:
        return self.text

    def describe(self) -> str:
        return f"'{self.text}'"


def normalize_to_list_of_substitutions(value: Any) -> Parts:
    """Text, a path, a substitution or several of them, as a list.

    Raises:
        InvalidLaunchValueError: anything else; names the value.
    """
    if isinstance(value, Substitution):
        return [value]
    if isinstance(value, (str, Path)):
        return [TextSubstitution(text=str(value))]
    if isinstance(value, Iterable) and not isinstance(value, (bytes, dict)):
        return [part for item in value for part in _single(item)]
    raise InvalidLaunchValueError(
        f"{value!r} ({type(value).__name__}): wanted text, a path, a substitution, "
        "or a list of these"
    )


def _single(item: Any) -> Parts:
    if isinstance(item, (str, Path, Substitution)):
        return normalize_to_list_of_substitutions(item)
    raise InvalidLaunchValueError(
        f"{item!r} ({type(item).__name__}) in a list: wanted text, a path or a "
        "substitution"
    )


def perform_substitutions(context: LaunchContext, parts: Iterable[Substitution]) -> str:
    """The texts of all parts, joined."""
    return "".join(part.perform(context) for part in parts)


def optional_parts(value: Any) -> Parts | None:
    """As :func:`normalize_to_list_of_substitutions`; None stays None."""
    return None if value is None else normalize_to_list_of_substitutions(value)


def describe_parts(parts: Iterable[Substitution]) -> str:
    """How joined parts read in an error or a listing."""
    return " + ".join(part.describe() for part in parts) or "''"
