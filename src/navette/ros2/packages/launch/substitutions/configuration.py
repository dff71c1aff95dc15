"""Substitutions of launch configurations, environment, scope and launch file."""

import os
import re
import socket
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
    Parts,
    SomeSubstitutionsType,
    Substitution,
)


class LaunchConfiguration(Substitution):
    """Value of a launch configuration (``$(var name)``)."""

    def __init__(self, variable_name: SomeSubstitutionsType, *, default: Any = None):
        self.variable_name = Parts.of(variable_name)
        self._default = None if default is None else _default_parts(default)

    def perform(self, context: LaunchContext) -> str:
        name = self.variable_name.perform(context)
        context.known_arguments.add(name)
        if name in context.launch_configurations:
            return str(context.launch_configurations[name])
        if self._default is None:
            known = sorted(context.launch_configurations)
            raise UndeclaredConfigurationFailure(name, known)
        return self._default.perform(context)


def _default_parts(default: Any) -> Parts:
    if isinstance(default, (str, Path, Substitution)):
        return Parts.of(default)
    if isinstance(default, Iterable):
        return Parts.of([d if isinstance(d, Substitution) else str(d) for d in default])
    return Parts.of(str(default))


class EnvironmentVariable(Substitution):
    """Value of an environment variable (``$(env NAME default)``)."""

    def __init__(
        self,
        name: SomeSubstitutionsType,
        *,
        default_value: SomeSubstitutionsType | None = None,
    ) -> None:
        self.name = Parts.of(name)
        self.default_value = None if default_value is None else Parts.of(default_value)

    def perform(self, context: LaunchContext) -> str:
        name = self.name.perform(context)
        value = context.environment.get(name)
        if value is not None:
            return value
        if self.default_value is None:
            raise SubstitutionFailure(
                f"environment variable {name!r} does not exist and has no default"
            )
        return self.default_value.perform(context)


class LocalSubstitution(Substitution):
    """Value of the present scope, such as ``event.pid`` in an event handler."""

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
                f"unknown local {self.expression!r}; known: "
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
        folder = context.get_locals_as_dict().get("current_launch_file_directory")
        return str(_launch_file(context).parent) if folder is None else str(folder)


def _launch_file(context: LaunchContext) -> Path:
    path = context.launch_file
    if path is None:
        raise SubstitutionFailure(
            "ThisLaunchFile: no launch file is running (the description was created by "
            "a program)"
        )
    return path


class LaunchLogDir(Substitution):
    """Folder of the logs (``$(log_dir)``)."""

    def perform(self, context: LaunchContext) -> str:
        return launch_config.log_dir


class AnonName(Substitution):
    """Unique name, the same for the same base within a launch (``$(anon x)``)."""

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self.name = Parts.of(name)

    def perform(self, context: LaunchContext) -> str:
        base = self.name.perform(context)
        given: dict[str, str] = context.notes.setdefault("anonymous names", {})
        name = f"{base}_{_host()}_{os.getpid()}_{len(given)}"
        return given.setdefault(base, name)


def _host() -> str:
    return re.sub(r"\W", "_", socket.gethostname())
