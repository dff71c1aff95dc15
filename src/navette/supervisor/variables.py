"""``$(var world)`` and the other substitutions of launch files, in ``navette.yaml``."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from navette.errors import InvalidValueError
from navette.ros2.packages.launch.errors import UndeclaredConfigurationFailure
from navette.ros2.packages.launch.frontend import parse_substitution
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.subprocesses import SubprocessRunner
from navette.ros2.packages.launch.substitution import perform_substitutions
from navette.runtime import VirtualClock
from navette.runtime.loop import EventLoop
from navette.runtime.parameter_files import parse_value


class Variables:
    """Works substitutions out.

    Args:
        values: what ``$(var …)`` gives.
        path: the file; ``$(dirname)`` is its folder.
    """

    def __init__(self, values: Mapping[str, str], path: Path) -> None:
        self._context = LaunchContext(
            loop=EventLoop(VirtualClock()), runner=SubprocessRunner()
        )
        self._context.launch_configurations.update(values)
        self._context.extend_locals({"current_launch_file_path": str(path)})

    def fill(self, text: str) -> str:
        """The text with everything worked out.

        Raises:
            NavetteError: a substitution is malformed or has no value.
        """
        if "$(" not in text:
            return text
        try:
            return perform_substitutions(self._context, parse_substitution(text))
        except UndeclaredConfigurationFailure as error:
            known = ", ".join(self._context.launch_configurations) or "none"
            raise InvalidValueError(
                f"{text!r}: no argument {error.name!r} (under 'arguments': {known})"
            ) from error

    def fill_value(self, value: Any) -> Any:
        """As :meth:`fill`, in lists and mappings too; what a substitution gives is
        read as a parameter file's value is (``$(var rate)`` may be a number).
        """
        if isinstance(value, str):
            return parse_value(self.fill(value)) if "$(" in value else value
        if isinstance(value, list):
            return [self.fill_value(each) for each in value]
        if isinstance(value, dict):
            return {str(key): self.fill_value(each) for key, each in value.items()}
        return value
