"""What is to be executed: a command line with its folder and environment."""

import os
import shlex
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.running import Command
from navette.ros2.packages.launch.substitution import (
    SomeSubstitutionsType,
    describe_parts,
    normalize_to_list_of_substitutions,
    optional_parts,
    perform_substitutions,
)

SomeVariables = Mapping[Any, Any]


class Executable:
    """A command line.

    Args:
        cmd: its words; each may be a list of substitutions.
        prefix: words before it, such as ``gdb -ex run --args``; split as a shell would.
        name: how it is called in the output, before a number.
        cwd: where it runs.
        env: its whole environment; else the launch's.
        additional_env: added to that.
        arguments: words behind it.
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
                f"cmd {cmd!r}: wanted a list of words, as in cmd=['ls', '-l']"
            )
        self.cmd = [normalize_to_list_of_substitutions(word) for word in cmd]
        self.cmd += [normalize_to_list_of_substitutions(w) for w in arguments or ()]
        if not self.cmd:
            raise InvalidLaunchValueError("cmd is empty")
        self.prefix = optional_parts(prefix)
        self.name = optional_parts(name)
        self.cwd = optional_parts(cwd)
        self.env = _variables(env)
        self.additional_env = _variables(additional_env)

    def describe(self) -> str:
        return " ".join(describe_parts(word) for word in self.cmd)

    def words(self, context: LaunchContext) -> list[str]:
        """The command line, without its prefix."""
        return [perform_substitutions(context, word) for word in self.cmd]

    def prefix_words(self, context: LaunchContext) -> list[str]:
        """What ``prefix``, or the argument ``launch-prefix``, puts before it."""
        if self.prefix is not None:
            return shlex.split(perform_substitutions(context, self.prefix))
        return shlex.split(context.launch_configurations.get("launch-prefix", ""))

    def working_folder(self, context: LaunchContext) -> str | None:
        """Where it runs; None: where the launch runs."""
        if self.cwd is None:
            return None
        folder = perform_substitutions(context, self.cwd)
        if not Path(folder).is_dir():
            raise InvalidLaunchValueError(f"cwd {folder!r}: no such folder")
        return folder

    def environment(self, context: LaunchContext) -> dict[str, str] | None:
        """Its whole environment; None: nothing differs from the launch's."""
        if self.env is None and self.additional_env is None:
            return None
        base = dict(os.environ) if self.env is None else _perform(context, self.env)
        return base | _perform(context, self.additional_env or [])

    def command(self, context: LaunchContext, *, shell: bool, tty: bool) -> Command:
        """Everything worked out, with a label that no other command has."""
        words = self.words(context)
        name = (
            perform_substitutions(context, self.name)
            if self.name is not None
            else Path(words[0].split()[0] if shell else words[0]).name
        )
        return Command(
            label=context.unique_name(name),
            argv=tuple(words),
            prefix=tuple(self.prefix_words(context)),
            cwd=self.working_folder(context),
            env=self.environment(context),
            shell=shell,
            tty=tty,
        )


def _variables(given: SomeVariables | None) -> list[tuple[Any, Any]] | None:
    if given is None:
        return None
    return [
        (
            normalize_to_list_of_substitutions(name),
            normalize_to_list_of_substitutions(value),
        )
        for name, value in given.items()
    ]


def _perform(
    context: LaunchContext, variables: list[tuple[Any, Any]]
) -> dict[str, str]:
    return {
        perform_substitutions(context, name): perform_substitutions(context, value)
        for name, value in variables
    }
