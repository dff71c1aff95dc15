"""Description of a component."""

from collections.abc import Iterable
from typing import Any

from navette.ros2.packages.launch import Condition
from navette.ros2.packages.launch.substitution import Parts
from navette.ros2.packages.launch_ros.utilities.parameters import (
    Normalized,
    normalize_parameters,
)
from navette.ros2.packages.launch_ros.utilities.remap_rules import (
    RemapRule,
    normalize_remap_rules,
)


class ComposableNode:
    """A node class to load into a container.

    Args:
        package: package of the class.
        plugin: the class: ``package::Class``, ``package.module.Class``,
            ``package.module:Class``, or a name registered as a component.
        name, namespace, parameters, remappings: as for a Node.
        extra_arguments: parameters for the container, such as
            ``use_intra_process_comms``; Navette's own container ignores them.
        condition: whether to load the class.
    """

    def __init__(
        self,
        *,
        package: Any,
        plugin: Any,
        name: Any = None,
        namespace: Any = None,
        parameters: Iterable[Any] | None = None,
        remappings: Iterable[Any] | None = None,
        extra_arguments: Iterable[Any] | None = None,
        condition: Condition | None = None,
    ) -> None:
        self.__package = Parts.of(package)
        self.__node_plugin = Parts.of(plugin)
        self.__node_name = Parts.optional(name)
        self.__node_namespace = Parts.optional(namespace)
        self.__parameters = _normalized(parameters)
        self.__remappings = tuple(normalize_remap_rules(remappings or ()))
        self.__extra_arguments = _normalized(extra_arguments)
        self.__condition = condition

    @property
    def package(self) -> Parts:
        return self.__package

    @property
    def node_plugin(self) -> Parts:
        return self.__node_plugin

    @property
    def node_name(self) -> Parts | None:
        return self.__node_name

    @property
    def node_namespace(self) -> Parts | None:
        return self.__node_namespace

    @property
    def parameters(self) -> Normalized:
        return self.__parameters

    @property
    def remappings(self) -> tuple[RemapRule, ...]:
        return self.__remappings

    @property
    def extra_arguments(self) -> Normalized:
        return self.__extra_arguments

    def condition(self) -> Condition | None:
        """Return the condition; a method, as in ROS 2."""
        return self.__condition

    def describe(self) -> str:
        return (
            f"ComposableNode({self.package.describe()} {self.node_plugin.describe()})"
        )


def _normalized(given: Iterable[Any] | None) -> Normalized:
    return () if given is None else normalize_parameters(given)
