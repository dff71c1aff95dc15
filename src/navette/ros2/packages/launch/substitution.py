"""Substitutions: text that is computed while the launch runs."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any, TypeAlias

from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext


class Substitution:
    """Base class of substitutions."""

    def perform(self, context: LaunchContext) -> str:
        """Return the text, given the launch's configurations and environment."""
        # As in ROS 2: a substitution without a text is a fault of the derived class.
        raise NotImplementedError(f"{type(self).__name__} does not implement perform()")

    def describe(self) -> str:
        """Describe the substitution in an error message or a listing."""
        return f"{type(self).__name__}({describe_first_parts(self)})"


SomeSubstitutionsType: TypeAlias = (
    str | Path | Substitution | Iterable[str | Path | Substitution]
)
SomeSubstitutionsType_types_tuple = (str, Path, Substitution, Iterable)


class Parts(list[Substitution]):
    """Substitutions whose texts are joined."""

    @classmethod
    def of(cls, value: Any) -> "Parts":
        """Convert text, a path, a substitution or several of them.

        Raises:
            InvalidLaunchValueError: any other value.
        """
        if isinstance(value, Substitution):
            return cls([value])
        if isinstance(value, (str, Path)):
            return cls([TextSubstitution(text=str(value))])
        if isinstance(value, Iterable) and not isinstance(value, (bytes, dict)):
            return cls(part for item in value for part in cls._of_item(item))
        raise InvalidLaunchValueError(
            f"{value!r} ({type(value).__name__}): expected text, a path, a "
            "substitution, or a list of these"
        )

    @classmethod
    def _of_item(cls, item: Any) -> "Parts":
        if isinstance(item, (str, Path, Substitution)):
            return cls.of(item)
        raise InvalidLaunchValueError(
            f"{item!r} ({type(item).__name__}) in a list: expected text, a path or a "
            "substitution"
        )

    @classmethod
    def optional(cls, value: Any) -> "Parts | None":
        """Convert a value as :meth:`of` does; None stays None."""
        return None if value is None else cls.of(value)

    def perform(self, context: LaunchContext) -> str:
        return "".join(part.perform(context) for part in self)

    def describe(self) -> str:
        return " + ".join(part.describe() for part in self) or "''"


def describe_first_parts(owner: object) -> str:
    """Describe the first substitutions among the attributes of an object."""
    values = vars(owner).values()
    first = next((value for value in values if isinstance(value, Parts)), None)
    return "" if first is None else first.describe()


class TextSubstitution(Substitution):
    """Constant text."""

    def __init__(self, *, text: str) -> None:
        if not isinstance(text, str):
            raise InvalidLaunchValueError(
                f"TextSubstitution: text {text!r}: expected a string"
            )
        self.text = text

    def perform(self, context: LaunchContext) -> str:
        return self.text

    def describe(self) -> str:
        return f"'{self.text}'"


def normalize_to_list_of_substitutions(value: Any) -> Parts:
    """Convert text, a path, a substitution or several of them to a list."""
    return Parts.of(value)


def perform_substitutions(context: LaunchContext, parts: Iterable[Substitution]) -> str:
    """Return the joined text of substitutions."""
    return Parts(parts).perform(context)
