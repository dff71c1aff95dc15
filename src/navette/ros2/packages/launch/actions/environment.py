"""Actions that set, append, unset and scope environment variables."""

import os
from typing import Any

from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import (
    Parts,
    SomeSubstitutionsType,
)
from navette.ros2.packages.launch.typed import perform_bool


class SetEnvironmentVariable(Action):
    """Sets a variable in the present scope."""

    def __init__(
        self,
        name: SomeSubstitutionsType,
        value: SomeSubstitutionsType,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.name = Parts.of(name)
        self.value = Parts.of(value)

    def execute(self, context: LaunchContext) -> None:
        name = self.name.perform(context)
        context.environment[name] = self.value.perform(context)


class AppendEnvironmentVariable(SetEnvironmentVariable):
    """Appends a value to a list of paths, or prepends it (``prepend``)."""

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
        self.separator = Parts.of(separator)

    def execute(self, context: LaunchContext) -> None:
        name = self.name.perform(context)
        parts = [self.value.perform(context)]
        before = context.environment.get(name)
        if before is not None:
            parts.insert(1 if perform_bool(context, self.prepend) else 0, before)
        separator = self.separator.perform(context)
        context.environment[name] = separator.join(parts)


class UnsetEnvironmentVariable(Action):
    """Unsets a variable in the present scope."""

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = Parts.of(name)

    def execute(self, context: LaunchContext) -> None:
        context.environment.pop(self.name.perform(context), None)


class PushEnvironment(Action):
    """Begins a scope of environment variables."""

    def execute(self, context: LaunchContext) -> None:
        context._push_environment()


class PopEnvironment(Action):
    """Ends a scope and restores the environment."""

    def execute(self, context: LaunchContext) -> None:
        context._pop_environment()


class ResetEnvironment(Action):
    """Restores the environment of the launch's start."""

    def execute(self, context: LaunchContext) -> None:
        context._reset_environment()
