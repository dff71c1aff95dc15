"""Actions that start containers and load components into them."""

from collections.abc import Iterable
from typing import Any

from navette.msgs.composition_interfaces.srv import LoadNode
from navette.ros2.packages.launch import Action, Event, LaunchDescriptionEntity
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.event_handler import CallbackHandler
from navette.ros2.packages.launch.events import Shutdown
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.logging import get_logger
from navette.ros2.packages.launch.running import PythonProgram
from navette.ros2.packages.launch.substitution import Parts, Substitution
from navette.ros2.packages.launch_ros.actions.node import Node
from navette.ros2.packages.launch_ros.descriptions import ComposableNode
from navette.ros2.packages.launch_ros.parameter_descriptions import ParameterFile
from navette.ros2.packages.launch_ros.ros_adapters import get_ros_adapter
from navette.ros2.packages.launch_ros.scope import (
    global_parameters,
    global_remaps,
    scoped_namespace,
)
from navette.ros2.packages.launch_ros.utilities.node_names import (
    add_node_name,
    repeated_name_warning,
)
from navette.ros2.packages.launch_ros.utilities.parameters import (
    Normalized,
    evaluate_parameters,
    normalize_parameter_dict,
    to_parameters_list,
)
from navette.ros2.packages.launch_ros.utilities.remap_rules import evaluate_remap_rules
from navette.runtime.names import validate_node_name

_NOTE = "containers"
_PATIENCE_S = 5.0
CONTAINER = PythonProgram(module="navette.ros2.launch.container", function="main")
"""The container program."""

_log = get_logger("launch_ros")


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
        self.__composable_node_descriptions = list(composable_node_descriptions or ())

    def _find(self, context: LaunchContext) -> PythonProgram:
        return CONTAINER

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        if context.is_shutdown:
            return None
        super().execute(context)
        _containers(context)[self.node_name] = self
        if not self.__composable_node_descriptions:
            return None
        return [
            LoadComposableNodes(
                composable_node_descriptions=self.__composable_node_descriptions,
                target_container=self,
            )
        ]


def _containers(context: LaunchContext) -> dict[str, ComposableNodeContainer]:
    """Return the containers that a launch has started, by full name."""
    known: dict[str, ComposableNodeContainer] = context.notes.setdefault(_NOTE, {})
    return known


class LoadComposableNodes(Action):
    """Loads components into a container, one after another.

    Args:
        target_container: the action that started it, or its full name; the latter may
            be any container on the graph.
    """

    def __init__(
        self,
        *,
        composable_node_descriptions: Iterable[ComposableNode],
        target_container: Any,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__composable_node_descriptions = list(composable_node_descriptions)
        for node in self.__composable_node_descriptions:
            if not isinstance(node, ComposableNode):
                raise InvalidLaunchValueError(
                    f"composable_node_descriptions: {node!r}: expected ComposableNode"
                )
        self.__target_container = (
            target_container
            if isinstance(target_container, ComposableNodeContainer)
            else Parts.of(target_container)
        )

    def describe(self) -> str:
        nodes = self.__composable_node_descriptions
        return (
            f"LoadComposableNodes({', '.join(n.node_plugin.describe() for n in nodes)})"
        )

    def execute(self, context: LaunchContext) -> None:
        target = self.__target_container
        if isinstance(target, ComposableNodeContainer):
            name = target.node_name
        else:
            name = f"/{target.perform(context).lstrip('/')}"
        # Evaluated now: the scope may end before the container is ready.
        requests = [
            request
            for node in self.__composable_node_descriptions
            if (request := get_composable_node_load_request(node, context)) is not None
        ]
        if requests and not context.is_shutdown:
            _Loading(context, name, requests).begin()


class _Loading:
    """Requests to one container, of which each waits for the previous response."""

    def __init__(
        self, context: LaunchContext, container: str, requests: list[Any]
    ) -> None:
        self._context = context
        self._container = container
        self._requests = requests
        self._has_warned = False

    def begin(self) -> None:
        """Keep the launch running until all nodes are loaded or it is shut down."""
        self._context.busy.add(self)
        self._context.register_event_handler(
            CallbackHandler(matcher=_is_shutdown, callback=self._abandon)
        )
        self._context.call_after(_PATIENCE_S, self._check, "composition")
        self._request_next()

    def _request_next(self) -> None:
        if not self._requests:
            self._context.busy.discard(self)
            return
        request = self._requests[0]
        get_ros_adapter(self._context).call(
            LoadNode,
            f"{self._container}/_container/load_node",
            request,
            lambda response: self._on_response(request, response),
        )

    def _on_response(self, request: Any, response: Any) -> None:
        self._requests = self._requests[1:]
        self._has_warned = True  # it responds
        name = response.full_node_name or request.node_name
        if response.success:
            add_node_name(self._context, name)
            warning = repeated_name_warning(self._context, name)
            if warning:
                _log.warning("%s", warning)
            _log.info("Loaded node '%s' in container '%s'", name, self._container)
        else:
            self._context.failed_labels.append(self._container)
            _log.error(
                "Failed to load node '%s' of type '%s' in container '%s': %s",
                name,
                request.plugin_name,
                self._container,
                response.error_message,
            )
        self._request_next()

    def _check(self) -> None:
        """Warn once about a container that does not respond."""
        if self._has_warned or not self._requests:
            return
        self._has_warned = True
        known = ", ".join(sorted(_containers(self._context))) or "none"
        _log.warning(
            "waiting for the container '%s' to load %d node(s); containers of this "
            "launch: %s",
            self._container,
            len(self._requests),
            known,
        )

    def _abandon(self, event: Event, context: LaunchContext) -> None:
        self._requests = []
        context.busy.discard(self)


def _is_shutdown(event: Event) -> bool:
    return isinstance(event, Shutdown)


def get_composable_node_load_request(
    composable_node_description: ComposableNode, context: LaunchContext
) -> Any:
    """Return the request to load a node; None if its condition does not hold."""
    node = composable_node_description
    condition = node.condition()
    if condition is not None and not condition.evaluate(context):
        return None
    request = LoadNode.Request()
    request.package_name = _text(context, node.package)
    request.plugin_name = _text(context, node.node_plugin)
    if node.node_name is not None:
        request.node_name = _text(context, node.node_name)
        validate_node_name(request.node_name)
    own = node.node_namespace
    namespace = scoped_namespace(context, None if own is None else _text(context, own))
    request.node_namespace = namespace or ""
    rules = [*global_remaps(context), *evaluate_remap_rules(context, node.remappings)]
    request.remap_rules = [f"{source}:={target}" for source, target in rules]
    of_scope: Normalized = tuple(
        ParameterFile(given)
        if not isinstance(given, tuple)
        else normalize_parameter_dict({given[0]: given[1]})
        for given in global_parameters(context)
    )
    for field, given in (
        ("parameters", (*of_scope, *node.parameters)),
        ("extra_arguments", node.extra_arguments),
    ):
        values = to_parameters_list(
            context,
            request.node_name,
            namespace,
            evaluate_parameters(context, given),
        )
        setattr(request, field, [value.to_parameter_msg() for value in values])
    return request


def _text(context: LaunchContext, parts: Iterable[Substitution]) -> str:
    return "".join(context.perform_substitution(part) for part in parts)
