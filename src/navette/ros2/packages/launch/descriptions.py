"""Descriptions of commands: command line, working directory, environment."""

import os
import re
import shlex
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.running import LaunchCommand, PythonProgram
from navette.ros2.packages.launch.substitution import (
    Parts,
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
)

__all__ = ["Executable"]

_INTERPRETER = re.compile(r"python[\d.]*")
_RCLPY = re.compile(rb"^\s*(?:import|from)\s+rclpy\b", re.MULTILINE)

SomeVariables = Mapping[Any, Any]


class Executable:
    """A command line.

    Args:
        cmd: its words; each may be a list of substitutions.
        prefix: words before it, such as ``gdb -ex run --args``; split as in a shell.
        name: its label in the output, before a number.
        cwd: working directory.
        env: its whole environment (default: that of the launch).
        additional_env: added to its environment.
        arguments: appended words.

    Attributes:
        final_cmd, final_name, final_cwd, final_env: results of :meth:`prepare`; None
            before.
    """

    def __init__(
        self,
        *,
        cmd: Iterable[Any],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: SomeVariables | None = None,
        additional_env: SomeVariables | None = None,
        arguments: Iterable[Any] | None = None,
    ) -> None:
        if isinstance(cmd, (str, Path)):
            raise InvalidLaunchValueError(
                f"cmd {cmd!r}: expected a list of words, as in cmd=['ls', '-l']"
            )
        words = [*cmd, *(arguments or ())]
        if not words:
            raise InvalidLaunchValueError("cmd is empty")
        self.cmd = [Parts.of(word) for word in words]
        self.prefix = Parts.optional(prefix)
        self.name = Parts.optional(name)
        self.cwd = Parts.optional(cwd)
        self.env = _variables(env)
        self.additional_env = _variables(additional_env)
        self._prefix: list[str] = []
        self._words: list[str] = []
        self.final_cmd: list[str] | None = None
        self.final_name: str | None = None
        self.final_cwd: str | None = None
        self.final_env: dict[str, str] | None = None

    def describe(self) -> str:
        return " ".join(word.describe() for word in self.cmd)

    def prepare(self, context: LaunchContext, action: Any = None) -> None:
        """Perform all substitutions; the results are in ``final_cmd`` and so on."""
        words = [word.perform(context) for word in self.cmd]
        self.set_final(context, words, Path((words[0].split() or [""])[0]).name)

    def set_final(self, context: LaunchContext, words: list[str], program: str) -> None:
        """Perform the substitutions of all but the words, which are given.

        Args:
            program: name of the program, the label of a command without a name.
        """
        self._prefix = self._prefix_words(context, program)
        self._words = words
        self.final_cmd = [*self._prefix, *words]
        self.final_name = context.unique_name(
            program if self.name is None else self.name.perform(context)
        )
        self.final_cwd = None if self.cwd is None else self.cwd.perform(context)
        self.final_env = self._environment(context)

    def _prefix_words(self, context: LaunchContext, program: str) -> list[str]:
        """Return the words of ``prefix`` or of the argument ``launch-prefix``.

        ``launch-prefix-filter`` is a pattern of the programs that get the latter.
        """
        if self.prefix is not None:
            return shlex.split(self.prefix.perform(context))
        given = context.launch_configurations
        pattern = given.get("launch-prefix-filter")
        if pattern is not None and not re.match(pattern, program):
            return []
        return shlex.split(given.get("launch-prefix", ""))

    def _environment(self, context: LaunchContext) -> dict[str, str] | None:
        """Return the whole environment; None: that of the launch."""
        if self.env is None and self.additional_env is None:
            return None
        base = dict(os.environ) if self.env is None else _perform(context, self.env)
        return base | _perform(context, self.additional_env or [])

    def command(self, *, shell: bool, tty: bool) -> LaunchCommand:
        """Return the prepared command."""
        if self.final_cwd is not None and not Path(self.final_cwd).is_dir():
            raise InvalidLaunchValueError(f"cwd {self.final_cwd!r}: no such folder")
        words = self._words
        script = None if shell else _ros_script(words, self.final_cwd)
        if script is not None:
            words = words[1:]
        needs_process = self._prefix or self.final_cwd or self.final_env is not None
        return LaunchCommand(
            label=self.final_name or "",
            argv=tuple(words),
            program=script,
            own_process=script is not None and bool(needs_process),
            prefix=tuple(self._prefix),
            cwd=self.final_cwd,
            env=self.final_env,
            shell=shell,
            tty=tty,
        )


def _ros_script(words: list[str], cwd: str | None) -> PythonProgram | None:
    """Return the program of ``python FILE.py …`` if the file imports rclpy.

    ROS 2's module names exist in programs that Navette starts, not in a plain Python.
    """
    if len(words) < 2 or not _INTERPRETER.fullmatch(Path(words[0]).name):
        return None
    file = Path(cwd or "", words[1])
    if file.suffix != ".py" or not file.is_file():
        return None
    return PythonProgram(file=file) if _RCLPY.search(file.read_bytes()) else None


def _variables(given: SomeVariables | None) -> list[tuple[Parts, Parts]] | None:
    if given is None:
        return None
    normalize = normalize_to_list_of_substitutions
    return [(normalize(name), normalize(value)) for name, value in given.items()]


def _perform(
    context: LaunchContext, variables: list[tuple[Parts, Parts]]
) -> dict[str, str]:
    return {name.perform(context): value.perform(context) for name, value in variables}
