"""Actions that declare arguments, and set, unset and scope configurations."""

from collections.abc import Sequence
from typing import Any

from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import (
    Parts,
    SomeSubstitutionsType,
)


class DeclareLaunchArgument(Action):
    """Declares an argument of the launch file, with or without a default.

    Raises:
        InvalidLaunchValueError: empty choices, or a default that is not a choice.
    """

    def __init__(
        self,
        name: str,
        *,
        default_value: SomeSubstitutionsType | None = None,
        description: str | None = None,
        choices: Sequence[str] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        if not isinstance(name, str) or not name:
            raise InvalidLaunchValueError(
                f"DeclareLaunchArgument: name {name!r}: expected text"
            )
        self.name = name
        self.default_value = Parts.optional(default_value)
        self.description = description or "no description given"
        self.choices = None if choices is None else list(choices)
        #: Whether the argument exists only under a condition; set by
        #: :meth:`LaunchDescription.get_launch_arguments`.
        self._conditionally_included = False
        if self.choices is not None and not self.choices:
            raise InvalidLaunchValueError(f"argument {name!r}: choices are empty")
        if self.choices is not None:
            self.description += f". Valid choices are: {self.choices}"
        if isinstance(default_value, str):
            self._check(default_value)

    @property
    def declares(self) -> str:
        """The declared name."""
        return self.name

    def describe(self) -> str:
        return f"DeclareLaunchArgument({self.name!r})"

    def describe_default(self) -> str:
        return "" if self.default_value is None else self.default_value.describe()

    def execute(self, context: LaunchContext) -> None:
        context.known_arguments.add(self.name)
        if self.name not in context.launch_configurations:
            if self.default_value is None:
                raise self.not_given()
            context.launch_configurations[self.name] = self.default_value.perform(
                context
            )
        self._check(context.launch_configurations[self.name])

    def not_given(self) -> InvalidLaunchValueError:
        return InvalidLaunchValueError(
            f"Required launch argument {self.name!r} was not provided: give "
            f"{self.name}:=value ({self.description})"
        )

    def _check(self, value: str) -> None:
        if self.choices is not None and value not in self.choices:
            raise InvalidLaunchValueError(
                f"argument {self.name!r}: {value!r} is not in provided choices: "
                f"{', '.join(self.choices)}"
            )


def describe_arguments(declared: Sequence[Any]) -> str:
    """Format declared arguments as ``ros2 launch --show-args`` does."""
    lines = ["Arguments (pass arguments as '<name>:=<value>'):", ""]
    if not declared:
        lines += ["  No arguments.", ""]
    for argument in declared:
        lines.append(f"    '{argument.name}':")
        lines.append(f"        {argument.description}")
        if argument.default_value is not None:
            lines.append(f"        (default: {argument.describe_default()})")
        lines.append("")
    return "\n".join(lines)


class SetLaunchConfiguration(Action):
    """Sets a configuration (``<let>``) in the present scope."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = Parts.of(name)
        self.value = Parts.of(value)

    def execute(self, context: LaunchContext) -> None:
        name = self.name.perform(context)
        context.known_arguments.add(name)
        value = self.value.perform(context)
        context.launch_configurations[name] = value


class UnsetLaunchConfiguration(Action):
    """Unsets a configuration in the present scope."""

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = Parts.of(name)

    def execute(self, context: LaunchContext) -> None:
        name = self.name.perform(context)
        context.launch_configurations.pop(name, None)


class PushLaunchConfigurations(Action):
    """Begins a scope of configurations."""

    def execute(self, context: LaunchContext) -> None:
        context._push_launch_configurations()


class PopLaunchConfigurations(Action):
    """Ends a scope and restores the configurations."""

    def execute(self, context: LaunchContext) -> None:
        context._pop_launch_configurations()


class ResetLaunchConfigurations(Action):
    """Replaces all configurations by the given ones."""

    #: Declarations after it are not arguments of the launch file.
    resets_arguments = True

    def __init__(
        self,
        launch_configurations: "dict[Any, Any] | None" = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.launch_configurations = dict(launch_configurations or {})

    def execute(self, context: LaunchContext) -> None:
        kept = {
            context.perform_substitution(name): context.perform_substitution(value)
            for name, value in self.launch_configurations.items()
        }
        context.launch_configurations.clear()
        context.launch_configurations.update(kept)
