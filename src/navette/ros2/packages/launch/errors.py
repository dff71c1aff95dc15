"""Exceptions of launches."""

from collections.abc import Sequence

from navette.errors import InvalidValueError, NavetteError


class LaunchError(NavetteError, RuntimeError):
    """A launch failed; the text names file, line and launch entity."""

    @classmethod
    def at(cls, where: str, entity: str, error: BaseException) -> "LaunchError":
        """Create the error for an exception of ``entity``, defined at ``where``."""
        kind = "" if isinstance(error, NavetteError) else f"{type(error).__name__}: "
        return cls(f"{where}: {entity}: {kind}{error}")


class SubstitutionFailure(NavetteError, RuntimeError):  # noqa: N818 - ROS 2's name
    """A substitution has no value."""


class UndeclaredConfigurationFailure(SubstitutionFailure):
    """The launch configuration ``name`` is not set."""

    def __init__(self, name: str, known: list[str]) -> None:
        super().__init__(
            f"launch configuration {name!r} does not exist (known: "
            f"{', '.join(known) or 'none'}); declare it with "
            f"DeclareLaunchArgument({name!r}) before its use"
        )
        self.name = name


class InvalidConditionExpressionError(InvalidValueError):
    """A condition is neither true nor false."""


class InvalidLaunchFileError(NavetteError, RuntimeError):
    """A file is not a valid launch file.

    Args:
        text: what is wrong.
        extension: ending of the file's name.
        likely_errors: what the parsers of its possible formats raised.
    """

    def __init__(
        self,
        text: str = "",
        *,
        extension: str = "",
        likely_errors: Sequence[BaseException] = (),
    ) -> None:
        problems = [f"{type(each).__name__}: {each}" for each in likely_errors]
        kind = f"launch file {extension!r} is not valid" if extension else ""
        super().__init__("; ".join(filter(None, [text or kind, *problems])))


class InvalidLaunchValueError(InvalidValueError, TypeError, RuntimeError):
    """An argument of an action or substitution has the wrong type or value."""
