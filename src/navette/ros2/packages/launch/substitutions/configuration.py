"""Substitutions by what the launch knows: arguments, environment, its own file."""

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from navette.ros2.packages.launch.errors import (
    SubstitutionFailure,
    UndeclaredConfigurationFailure,
)
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.logging import launch_config
from navette.ros2.packages.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe_parts,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class LaunchConfiguration(Substitution):
    """The value of a launch argument (``$(var name)``)."""

    def __init__(self, variable_name: SomeSubstitutionsType, *, default: Any = None):
        self.variable_name = normalize_to_list_of_substitutions(variable_name)
        self._default = None if default is None else _default_parts(default)

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self.variable_name)
        context.known_arguments.add(name)
        if name in context.launch_configurations:
            return context.launch_configurations[name]
        if self._default is None:
            known = sorted(context.launch_configurations)
            raise UndeclaredConfigurationFailure(name, known)
        return perform_substitutions(context, self._default)

    def describe(self) -> str:
        return f"LaunchConfiguration({describe_parts(self.variable_name)})"


def _default_parts(default: Any) -> list[Substitution]:
    if isinstance(default, (str, Path, Substitution)):
        return normalize_to_list_of_substitutions(default)
    if isinstance(default, Iterable):
        return normalize_to_list_of_substitutions(
            [d if isinstance(d, Substitution) else str(d) for d in default]
        )
    return normalize_to_list_of_substitutions(str(default))


class EnvironmentVariable(Substitution):
    """The value of an environment variable (``$(env NAME default)``)."""

    def __init__(
        self,
        name: SomeSubstitutionsType,
        *,
        default_value: SomeSubstitutionsType | None = None,
    ) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self.default_value = (
            None
            if default_value is None
            else normalize_to_list_of_substitutions(default_value)
        )

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self.name)
        value = context.environment.get(name)
        if value is not None:
            return value
        if self.default_value is None:
            raise SubstitutionFailure(
                f"environment variable {name!r} is not set, and there is no default"
            )
        return perform_substitutions(context, self.default_value)

    def describe(self) -> str:
        return f"EnvironmentVariable({describe_parts(self.name)})"


class LocalSubstitution(Substitution):
    """A value of the present scope, such as ``event.pid`` in an event handler."""

    def __init__(self, expression: str, description: str | None = None) -> None:
        self.expression = expression
        self.description = description

    def perform(self, context: LaunchContext) -> str:
        known = context.get_locals_as_dict()
        name, *attributes = self.expression.split(".")
        try:
            value = known[name]
            for attribute in attributes:
                value = getattr(value, attribute)
        except (KeyError, AttributeError):
            raise SubstitutionFailure(
                f"no local {self.expression!r} here; there are: "
                f"{', '.join(sorted(known)) or 'none'}"
            ) from None
        return str(value)

    def describe(self) -> str:
        return f"LocalSubstitution('{self.description or self.expression}')"


class ThisLaunchFile(Substitution):
    """Path of the launch file (``$(filename)``)."""

    def perform(self, context: LaunchContext) -> str:
        return str(_launch_file(context))


class ThisLaunchFileDir(Substitution):
    """Folder of the launch file (``$(dirname)``)."""

    def perform(self, context: LaunchContext) -> str:
        return str(_launch_file(context).parent)


def _launch_file(context: LaunchContext) -> Path:
    path = context.launch_file
    if path is None:
        raise SubstitutionFailure(
            "ThisLaunchFile: no launch file is being run (the description was made in "
            "a program)"
        )
    return path


class LaunchLogDir(Substitution):
    """The folder for logs (``$(log_dir)``)."""

    def perform(self, context: LaunchContext) -> str:
        return launch_config.log_dir


class AnonName(Substitution):
    """A name that no other launch has, the same for the same base (``$(anon x)``)."""

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self.name = normalize_to_list_of_substitutions(name)

    def perform(self, context: LaunchContext) -> str:
        base = perform_substitutions(context, self.name)
        given: dict[str, str] = context.notes.setdefault("anonymous names", {})
        return given.setdefault(base, f"{base}_{os.getpid()}_{len(given)}")
