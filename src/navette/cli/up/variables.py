"""Substitutions of launch files, as ``$(var world)``, in ``navette.yaml``."""

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
    """Expands substitutions.

    Args:
        values: values of ``$(var …)``.
        path: the file; ``$(dirname)`` is its folder.
    """

    def __init__(self, values: Mapping[str, str], path: Path) -> None:
        self._context = LaunchContext(
            loop=EventLoop(VirtualClock()), runner=SubprocessRunner()
        )
        self._context.launch_configurations.update(values)
        self._context.extend_locals({"current_launch_file_path": str(path)})

    def expand(self, text: str) -> str:
        """Return the text with all substitutions expanded.

        Raises:
            NavetteError: a malformed substitution, or one without a value.
        """
        if "$(" not in text:
            return text
        try:
            return perform_substitutions(self._context, parse_substitution(text))
        except UndeclaredConfigurationFailure as error:
            known = ", ".join(self._context.launch_configurations) or "none"
            raise InvalidValueError(
                f"{text!r}: unknown argument {error.name!r} (declared under "
                f"'arguments': {known})"
            ) from error

    def expand_value(self, value: Any) -> Any:
        """Expand strings in nested lists and mappings.

        An expanded string gets the type that a parameter file would give it:
        ``$(var rate)`` may become a number.
        """
        if isinstance(value, str):
            return parse_value(self.expand(value)) if "$(" in value else value
        if isinstance(value, list):
            return [self.expand_value(each) for each in value]
        if isinstance(value, dict):
            return {str(key): self.expand_value(each) for key, each in value.items()}
        return value
