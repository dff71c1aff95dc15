"""Environment variables: set, append, unset, keep apart."""

import os
from typing import Any

from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import (
    SomeSubstitutionsType,
    describe_parts,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from navette.ros2.packages.launch.typed import perform_bool


class SetEnvironmentVariable(Action):
    """Set a variable for what is started from here on in this scope."""

    def __init__(
        self,
        name: SomeSubstitutionsType,
        value: SomeSubstitutionsType,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.name = normalize_to_list_of_substitutions(name)
        self.value = normalize_to_list_of_substitutions(value)

    def describe(self) -> str:
        return f"{type(self).__name__}({describe_parts(self.name)})"

    def execute(self, context: LaunchContext) -> None:
        name = perform_substitutions(context, self.name)
        context.environment[name] = perform_substitutions(context, self.value)


class AppendEnvironmentVariable(SetEnvironmentVariable):
    """Add to a list of paths, behind what is there (or before, with ``prepend``)."""

    def __init__(
        self,
        name: SomeSubstitutionsType,
        value: SomeSubstitutionsType,
        prepend: Any = False,
        separator: SomeSubstitutionsType = os.pathsep,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, value, **kwargs)
        self.prepend = prepend
        self.separator = normalize_to_list_of_substitutions(separator)

    def execute(self, context: LaunchContext) -> None:
        name = perform_substitutions(context, self.name)
        parts = [perform_substitutions(context, self.value)]
        before = context.environment.get(name)
        if before is not None:
            parts.insert(1 if perform_bool(context, self.prepend) else 0, before)
        separator = perform_substitutions(context, self.separator)
        context.environment[name] = separator.join(parts)


class UnsetEnvironmentVariable(Action):
    """Take a variable away, in this scope."""

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = normalize_to_list_of_substitutions(name)

    def describe(self) -> str:
        return f"UnsetEnvironmentVariable({describe_parts(self.name)})"

    def execute(self, context: LaunchContext) -> None:
        context.environment.pop(perform_substitutions(context, self.name), None)


class PushEnvironment(Action):
    """Begin a scope of environment variables."""

    def execute(self, context: LaunchContext) -> None:
        context.push_environment()


class PopEnvironment(Action):
    """End a scope: the environment is as it was."""

    def execute(self, context: LaunchContext) -> None:
        context.pop_environment()


class ResetEnvironment(Action):
    """Back to the environment that the launch was started with."""

    def execute(self, context: LaunchContext) -> None:
        context.reset_environment()
