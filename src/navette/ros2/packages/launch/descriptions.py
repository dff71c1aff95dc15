"""Descriptions of commands: command line, working directory, environment."""

import os
import shlex
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.running import LaunchCommand
from navette.ros2.packages.launch.substitution import (
    Parts,
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
)

__all__ = ["Executable"]

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

    def describe(self) -> str:
        return " ".join(word.describe() for word in self.cmd)

    def prefix_words(self, context: LaunchContext) -> list[str]:
        """Return the words of ``prefix`` or of the argument ``launch-prefix``."""
        if self.prefix is not None:
            return shlex.split(self.prefix.perform(context))
        return shlex.split(context.launch_configurations.get("launch-prefix", ""))

    def working_folder(self, context: LaunchContext) -> str | None:
        """Return the working directory; None: that of the launch."""
        if self.cwd is None:
            return None
        folder = self.cwd.perform(context)
        if not Path(folder).is_dir():
            raise InvalidLaunchValueError(f"cwd {folder!r}: no such folder")
        return folder

    def environment(self, context: LaunchContext) -> dict[str, str] | None:
        """Return the whole environment; None: that of the launch."""
        if self.env is None and self.additional_env is None:
            return None
        base = dict(os.environ) if self.env is None else _perform(context, self.env)
        return base | _perform(context, self.additional_env or [])

    def command(
        self, context: LaunchContext, *, shell: bool, tty: bool
    ) -> LaunchCommand:
        """Return the command, with a label that is unique in the launch."""
        words = [word.perform(context) for word in self.cmd]
        name = (
            self.name.perform(context)
            if self.name is not None
            else Path(words[0].split()[0] if shell else words[0]).name
        )
        return LaunchCommand(
            label=context.unique_name(name),
            argv=tuple(words),
            prefix=tuple(self.prefix_words(context)),
            cwd=self.working_folder(context),
            env=self.environment(context),
            shell=shell,
            tty=tty,
        )


def _variables(given: SomeVariables | None) -> list[tuple[Parts, Parts]] | None:
    if given is None:
        return None
    normalize = normalize_to_list_of_substitutions
    return [(normalize(name), normalize(value)) for name, value in given.items()]


def _perform(
    context: LaunchContext, variables: list[tuple[Parts, Parts]]
) -> dict[str, str]:
    return {name.perform(context): value.perform(context) for name, value in variables}
