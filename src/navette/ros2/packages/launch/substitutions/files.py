"""Substitutions of paths, file contents, executables and command output."""

import os
import shlex
import shutil
import subprocess
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from navette.ros2.packages.launch.errors import (
    InvalidLaunchValueError,
    SubstitutionFailure,
)
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.logging import get_logger
from navette.ros2.packages.launch.ros2_command import with_ros2
from navette.ros2.packages.launch.substitution import (
    Parts,
    SomeSubstitutionsType,
    Substitution,
)

_MAX_BYTES = 16 * 1024 * 1024
_ON_STDERR = ("fail", "ignore", "warn", "capture")


class PathJoinSubstitution(Substitution):
    """Joined path; a part may be a list of substitutions."""

    def __init__(self, substitutions: Iterable[Any]) -> None:
        if isinstance(substitutions, (str, Path, Substitution)):
            substitutions = [substitutions]
        self.parts = [Parts.of(p) for p in substitutions]

    def perform(self, context: LaunchContext) -> str:
        parts = [part.perform(context) for part in self.parts]
        return str(Path(*parts)) if parts else ""

    def __truediv__(self, part: Any) -> "PathJoinSubstitution":
        return PathJoinSubstitution([*self.parts, part])

    def describe(self) -> str:
        return f"PathJoin({' / '.join(part.describe() for part in self.parts)})"


PathSubstitution = PathJoinSubstitution


class FileContent(Substitution):
    """Content of a file (``$(file-content path)``)."""

    def __init__(self, path: SomeSubstitutionsType) -> None:
        self.path = Parts.of(path)

    def perform(self, context: LaunchContext) -> str:
        path = Path(self.path.perform(context))
        try:
            if path.stat().st_size > _MAX_BYTES:
                raise SubstitutionFailure(f"{path}: more than {_MAX_BYTES} bytes")
            return path.read_text(encoding="utf-8")
        except FileNotFoundError as error:
            raise SubstitutionFailure(f"File not found: {path}") from error
        except (OSError, UnicodeDecodeError) as error:
            raise SubstitutionFailure(f"{path}: cannot be read: {error}") from error


class FindExecutable(Substitution):
    """Path of a program on ``PATH`` (``$(find-exec name)``)."""

    def __init__(self, *, name: SomeSubstitutionsType) -> None:
        self.name = Parts.of(name)

    def perform(self, context: LaunchContext) -> str:
        name = self.name.perform(context)
        environment = with_ros2(None) if name == "ros2" else None
        found = shutil.which(name, path=(environment or os.environ).get("PATH"))
        if found is None:
            raise SubstitutionFailure(
                f"executable {name!r} is not on PATH ({os.environ.get('PATH', '')})"
            )
        return found


class Command(Substitution):
    """Output of a command (``$(command 'xacro robot.xacro')``).

    Args:
        command: split as in a shell, but run without one.
        on_stderr: effect of error output: fail, ignore, warn or capture.
    """

    def __init__(
        self,
        command: SomeSubstitutionsType,
        *,
        on_stderr: SomeSubstitutionsType = "fail",
    ) -> None:
        self.command = Parts.of(command)
        self.on_stderr = Parts.of(on_stderr)

    def perform(self, context: LaunchContext) -> str:
        text = self.command.perform(context)
        mode = self.on_stderr.perform(context)
        if mode not in _ON_STDERR:
            raise InvalidLaunchValueError(
                f"Command: on_stderr {mode!r}; expected {', '.join(_ON_STDERR)}"
            )
        try:
            done = subprocess.run(
                shlex.split(text), capture_output=True, text=True, check=False
            )
        except FileNotFoundError as error:
            raise SubstitutionFailure(f"file not found: command {text!r}") from error
        except (OSError, ValueError) as error:
            raise SubstitutionFailure(f"command {text!r}: {error}") from error
        if done.returncode != 0:
            raise SubstitutionFailure(
                f"executed command failed. Command: {text}; code {done.returncode}: "
                f"{done.stderr.strip()}"
            )
        if done.stderr and mode == "fail":
            raise SubstitutionFailure(
                f"executed command showed stderr output. Command: {text}\n"
                f"{done.stderr.strip()}"
            )
        if done.stderr and mode == "warn":
            get_logger("launch").warning("command %r: %s", text, done.stderr.strip())
        return done.stdout + (done.stderr if mode == "capture" else "")
