"""Nodes that share a process and a loop: classes loaded into a container."""

import json
from collections.abc import Iterable
from typing import Any

from navette.ros2.packages.launch import Condition
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import (
    describe_parts,
    normalize_to_list_of_substitutions,
    optional_parts,
    perform_substitutions,
)
from navette.ros2.packages.launch_ros.node_arguments import (
    evaluate_parameters,
    evaluate_remaps,
    ros_arguments,
)
from navette.ros2.packages.launch_ros.scope import joined_namespace, pushed_namespace
from navette.runtime.names import validate_node_name


class ComposableNode:
    """A node class to be loaded into a container.

    Args:
        package: where it is from.
        plugin: the class: ``package::Class``, ``package.module.Class``,
            ``package.module:Class``, or a name registered as a component.
        name, namespace, parameters, remappings: as of a Node.
        extra_arguments: accepted; what they ask for is always so here.
        condition: whether it is loaded.
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
        self.package = normalize_to_list_of_substitutions(package)
        self.node_plugin = normalize_to_list_of_substitutions(plugin)
        self.node_name = optional_parts(name)
        self.node_namespace = optional_parts(namespace)
        self.parameters = list(parameters or ())
        self.remappings = list(remappings or ())
        self.extra_arguments = list(extra_arguments or ())
        self.condition = condition

    def describe(self) -> str:
        return (
            f"ComposableNode({describe_parts(self.package)} "
            f"{describe_parts(self.node_plugin)})"
        )

    def load_request(self, context: LaunchContext) -> bytes:
        """One line of JSON for the container."""
        name = None
        if self.node_name is not None:
            name = perform_substitutions(context, self.node_name)
            validate_node_name(name)
        own = (
            ""
            if self.node_namespace is None
            else perform_substitutions(context, self.node_namespace)
        )
        words = ros_arguments(
            name,
            joined_namespace(pushed_namespace(context), own),
            evaluate_parameters(context, self.parameters),
            evaluate_remaps(context, self.remappings),
        )
        request = {
            "package": perform_substitutions(context, self.package),
            "plugin": perform_substitutions(context, self.node_plugin),
            "arguments": words,
        }
        return json.dumps(request).encode() + b"\n"
