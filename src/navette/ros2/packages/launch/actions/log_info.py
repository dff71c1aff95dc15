"""Actions that log a message."""

import logging
from typing import Any

from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.logging import get_logger
from navette.ros2.packages.launch.substitution import (
    Parts,
    SomeSubstitutionsType,
)

_log = get_logger("launch.user")
_LEVELS = ("debug", "info", "warning", "error")


class Log(Action):
    """Logs a message with a level: debug, info, warning or error."""

    def __init__(
        self, *, msg: SomeSubstitutionsType, level: SomeSubstitutionsType, **kwargs: Any
    ) -> None:
        super().__init__(**kwargs)
        self.msg = Parts.of(msg)
        self.level = Parts.of(level)

    def execute(self, context: LaunchContext) -> None:
        level = self.level.perform(context).lower()
        level = "warning" if level == "warn" else level
        if level not in _LEVELS:
            raise InvalidLaunchValueError(
                f"log level {level!r}; expected {', '.join(_LEVELS)}"
            )
        number = logging.getLevelNamesMapping()[level.upper()]
        _log.log(number, "%s", self.msg.perform(context))


class LogInfo(Log):
    """Logs a message."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level="info", **kwargs)


class LogWarning(Log):
    """Logs a warning."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level="warning", **kwargs)


class LogError(Log):
    """Logs an error; the launch continues."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level="error", **kwargs)


class LogDebug(Log):
    """Logs a message that is printed with ``--debug`` only."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level="debug", **kwargs)
