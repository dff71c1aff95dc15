"""Substitution of a parameter set by SetParameter."""

from typing import Any

from navette.ros2.packages.launch import SomeSubstitutionsType, Substitution
from navette.ros2.packages.launch.errors import SubstitutionFailure
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import Parts
from navette.ros2.packages.launch_ros.scope import global_parameters


class Parameter(Substitution):
    """Value set by SetParameter in this scope (``$(param name)``)."""

    def __init__(self, name: SomeSubstitutionsType, *, default: Any = None) -> None:
        self.name = Parts.of(name)
        self.default = Parts.optional(default)

    def perform(self, context: LaunchContext) -> str:
        name = self.name.perform(context)
        for given in reversed(global_parameters(context)):
            if isinstance(given, tuple) and given[0] == name:
                value = given[1]
                return str(value).lower() if isinstance(value, bool) else str(value)
        if self.default is not None:
            return self.default.perform(context)
        raise SubstitutionFailure(f"parameter {name!r} is not set with SetParameter")
