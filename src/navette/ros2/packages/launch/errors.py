"""What goes wrong in a launch, and in which file, line and entity."""

from navette.errors import InvalidValueError, NavetteError


class LaunchError(NavetteError, RuntimeError):
    """A launch cannot go on; the text names file, line and launch entity."""

    @classmethod
    def at(cls, where: str, entity: str, error: BaseException) -> "LaunchError":
        """The error to raise for what ``entity``, written at ``where``, ran into."""
        kind = "" if isinstance(error, NavetteError) else f"{type(error).__name__}: "
        return cls(f"{where}: {entity}: {kind}{error}")


class SubstitutionFailure(NavetteError, RuntimeError):  # noqa: N818 - ROS 2's name
    """A substitution has no value."""


class UndeclaredConfigurationFailure(SubstitutionFailure):
    """A launch configuration that nothing has set; ``name`` is its name."""

    def __init__(self, name: str, known: list[str]) -> None:
        super().__init__(
            f"launch configuration {name!r} does not exist; there are: "
            f"{', '.join(known) or 'none'}. "
            f"Declare it with DeclareLaunchArgument({name!r}) before its use"
        )
        self.name = name


class InvalidConditionExpressionError(InvalidValueError):
    """A condition is neither true nor false."""


class InvalidLaunchFileError(NavetteError, RuntimeError):
    """A file cannot be read as a launch file."""


class InvalidLaunchValueError(InvalidValueError, TypeError):
    """An argument of an action or substitution is of the wrong type."""
