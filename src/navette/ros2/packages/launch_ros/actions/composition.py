"""Actions that start containers and load components into them."""

from collections.abc import Iterable
from typing import Any

from navette.ros2.packages.launch import Action, LaunchDescriptionEntity
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.running import PythonProgram
from navette.ros2.packages.launch.substitution import Parts
from navette.ros2.packages.launch_ros.actions.node import Node
from navette.ros2.packages.launch_ros.descriptions import ComposableNode
from navette.ros2.packages.launch_ros.scope import joined_namespace, pushed_namespace

_NOTE = "containers"
CONTAINER = PythonProgram(module="navette.ros2.launch.container", function="main")
"""The container program."""


class ComposableNodeContainer(Node):
    """Starts a container and loads components into it.

    ``package`` and ``executable`` may name any container of ROS 2; Navette's own
    container is started.
    """

    def __init__(
        self,
        *,
        name: Any,
        namespace: Any,
        composable_node_descriptions: Iterable[ComposableNode] | None = None,
        package: Any = "rclcpp_components",
        executable: Any = "component_container",
        **kwargs: Any,
    ) -> None:
        super().__init__(
            name=name,
            namespace=namespace,
            package=package,
            executable=executable,
            **kwargs,
        )
        self._nodes = list(composable_node_descriptions or ())

    def _find(self, context: LaunchContext) -> PythonProgram:
        return CONTAINER

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        if context.is_shutdown:
            return None
        super().execute(context)
        containers: dict[str, ComposableNodeContainer]
        containers = context.notes.setdefault(_NOTE, {})
        containers[self.node_name] = self
        if not self._nodes:
            return None
        return [
            LoadComposableNodes(
                composable_node_descriptions=self._nodes, target_container=self
            )
        ]


class LoadComposableNodes(Action):
    """Loads components into a container, given as an action or by name."""

    def __init__(
        self,
        *,
        composable_node_descriptions: Iterable[ComposableNode],
        target_container: Any,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._nodes = list(composable_node_descriptions)
        for node in self._nodes:
            if not isinstance(node, ComposableNode):
                raise InvalidLaunchValueError(
                    f"composable_node_descriptions: {node!r}: expected ComposableNode"
                )
        self._target = (
            target_container
            if isinstance(target_container, ComposableNodeContainer)
            else Parts.of(target_container)
        )

    def describe(self) -> str:
        nodes = ", ".join(node.node_plugin.describe() for node in self._nodes)
        return f"LoadComposableNodes({nodes})"

    def execute(self, context: LaunchContext) -> None:
        container = self._container(context)
        for node in self._nodes:
            if node.condition is None or node.condition.evaluate(context):
                container.write(node.load_request(context))

    def _container(self, context: LaunchContext) -> ComposableNodeContainer:
        if isinstance(self._target, ComposableNodeContainer):
            if self._target.process_details is None:
                raise InvalidLaunchValueError(
                    "target_container: the container was not started yet"
                )
            return self._target
        name = self._target.perform(context)
        full_name = joined_namespace(pushed_namespace(context) or "/", name)
        known: dict[str, ComposableNodeContainer] = context.notes.get(_NOTE, {})
        if full_name not in known:
            raise InvalidLaunchValueError(
                f"unknown target_container {full_name!r}; started containers: "
                f"{', '.join(sorted(known)) or 'none'}"
            )
        return known[full_name]
