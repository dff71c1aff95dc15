"""Description of a component."""

import json
from collections.abc import Iterable
from typing import Any

from navette.ros2.packages.launch import Condition
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import Parts
from navette.ros2.packages.launch_ros.node_arguments import (
    evaluate_parameters,
    evaluate_remaps,
    ros_arguments,
)
from navette.ros2.packages.launch_ros.scope import joined_namespace, pushed_namespace
from navette.runtime.names import validate_node_name


class ComposableNode:
    """A node class to load into a container.

    Args:
        package: package of the class.
        plugin: the class: ``package::Class``, ``package.module.Class``,
            ``package.module:Class``, or a name registered as a component.
        name, namespace, parameters, remappings: as for a Node.
        extra_arguments: accepted without effect.
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
        self.package = Parts.of(package)
        self.node_plugin = Parts.of(plugin)
        self.node_name = Parts.optional(name)
        self.node_namespace = Parts.optional(namespace)
        self.parameters = list(parameters or ())
        self.remappings = list(remappings or ())
        self.extra_arguments = list(extra_arguments or ())
        self.condition = condition

    def describe(self) -> str:
        return (
            f"ComposableNode({self.package.describe()} {self.node_plugin.describe()})"
        )

    def load_request(self, context: LaunchContext) -> bytes:
        """Return the load request for the container, one line of JSON."""
        name = None
        if self.node_name is not None:
            name = self.node_name.perform(context)
            validate_node_name(name)
        own = (
            "" if self.node_namespace is None else self.node_namespace.perform(context)
        )
        words = ros_arguments(
            name,
            joined_namespace(pushed_namespace(context), own),
            evaluate_parameters(context, self.parameters),
            evaluate_remaps(context, self.remappings),
        )
        request = {
            "package": self.package.perform(context),
            "plugin": self.node_plugin.perform(context),
            "arguments": words,
        }
        return json.dumps(request).encode() + b"\n"
