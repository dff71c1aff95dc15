"""Launch arguments and configurations: declare, set, unset, keep apart."""

from collections.abc import Sequence
from typing import Any

from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import (
    SomeSubstitutionsType,
    describe_parts,
    normalize_to_list_of_substitutions,
    optional_parts,
    perform_substitutions,
)


class DeclareLaunchArgument(Action):
    """An argument of the launch file, with or without a default.

    Raises:
        InvalidLaunchValueError: no choices, or a default that is none of them.
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
                f"DeclareLaunchArgument: name {name!r}: wanted text"
            )
        self.name = name
        self.default_value = optional_parts(default_value)
        self.description = description or ""
        self.choices = None if choices is None else list(choices)
        if self.choices is not None and not self.choices:
            raise InvalidLaunchValueError(f"argument {name!r}: choices are empty")
        if isinstance(default_value, str):
            self._check(default_value)

    @property
    def declares(self) -> str:
        """The name, for those who collect declarations."""
        return self.name

    def describe(self) -> str:
        return f"DeclareLaunchArgument({self.name!r})"

    def describe_default(self) -> str:
        """The default as a person reads it."""
        return "" if self.default_value is None else describe_parts(self.default_value)

    def execute(self, context: LaunchContext) -> None:
        context.known_arguments.add(self.name)
        if self.name not in context.launch_configurations:
            if self.default_value is None:
                raise InvalidLaunchValueError(
                    f"argument {self.name!r} is required: give {self.name}:=value"
                    + (f" ({self.description})" if self.description else "")
                )
            context.launch_configurations[self.name] = perform_substitutions(
                context, self.default_value
            )
        self._check(context.launch_configurations[self.name])

    def _check(self, value: str) -> None:
        if self.choices is not None and value not in self.choices:
            raise InvalidLaunchValueError(
                f"argument {self.name!r}: {value!r}; wanted one of "
                f"{', '.join(self.choices)}"
            )


class SetLaunchConfiguration(Action):
    """Set a configuration (``<let>``) from here on in this scope."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = normalize_to_list_of_substitutions(name)
        self.value = normalize_to_list_of_substitutions(value)

    def describe(self) -> str:
        return f"SetLaunchConfiguration({describe_parts(self.name)})"

    def execute(self, context: LaunchContext) -> None:
        name = perform_substitutions(context, self.name)
        context.known_arguments.add(name)
        value = perform_substitutions(context, self.value)
        context.launch_configurations[name] = value


class UnsetLaunchConfiguration(Action):
    """Forget a configuration from here on in this scope."""

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = normalize_to_list_of_substitutions(name)

    def execute(self, context: LaunchContext) -> None:
        name = perform_substitutions(context, self.name)
        context.launch_configurations.pop(name, None)


class PushLaunchConfigurations(Action):
    """Begin a scope of configurations."""

    def execute(self, context: LaunchContext) -> None:
        context.push_launch_configurations()


class PopLaunchConfigurations(Action):
    """End a scope: configurations are as they were."""

    def execute(self, context: LaunchContext) -> None:
        context.pop_launch_configurations()


class ResetLaunchConfigurations(Action):
    """Keep none of the configurations but those given."""

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
