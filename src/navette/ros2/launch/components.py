"""Components: nodes loaded into a running program by a launch file or a service.

The services are those of ROS 2's containers: ``~/_container/load_node``,
``unload_node`` and ``list_nodes``.
"""

import importlib
import inspect
import itertools
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import entry_points
from typing import Any

from navette.errors import NavetteError, UnknownNameError
from navette.runtime import Context, Executor, Node, Parameter
from navette.runtime.arguments import RosArguments, parse_ros_arguments
from navette.runtime.overrides import ParameterOverrides

GROUP = "rclpy_components"
_PACKAGE = "composition_interfaces/srv"


class ComponentLoadError(NavetteError):
    """A component cannot be loaded."""


class ComponentManager:
    """Loads node classes, runs the nodes on one executor, and unloads them.

    Args:
        node: serves the requests; a node of the executor.
    """

    def __init__(self, node: Node, executor: Executor) -> None:
        self._executor = executor
        self._log = node.get_logger()
        self._ids = itertools.count(1)
        self._nodes: dict[int, Node] = {}
        for name, service, callback in (
            ("LoadNode", "load_node", self._on_load),
            ("UnloadNode", "unload_node", self._on_unload),
            ("ListNodes", "list_nodes", self._on_list),
        ):
            node._node_serve(f"{_PACKAGE}/{name}", f"~/_container/{service}", callback)

    def load(
        self, package: str, plugin: str, arguments: RosArguments, origin: str
    ) -> int:
        """Create a node of the plugin's class and return its id.

        Args:
            arguments: the node's own; replace the container's.
            origin: source of the arguments, for error messages.

        Raises:
            UnknownNameError: unknown class.
            NavetteError: exceptions of the class or its parameters.
        """
        context = self._executor.context
        node_class = find_component(package, plugin)
        before = list(context.nodes)
        try:
            with _arguments_of(context, arguments, origin):
                takes_context = "context" in inspect.signature(node_class).parameters
                node = node_class(context=context) if takes_context else node_class()
                context.check_overrides([n for n in context.nodes if n not in before])
        except Exception:  # the component may raise anything; raised again
            for half_made in [n for n in context.nodes if n not in before]:
                half_made.destroy_node()
            raise
        self._executor.add_node(node)
        number = next(self._ids)
        self._nodes[number] = node
        node.get_logger().info(f"loaded {plugin} as {node.get_fully_qualified_name()}")
        return number

    def unload(self, number: int) -> None:
        """Destroy a node.

        Raises:
            UnknownNameError: unknown id; lists the known ones.
        """
        if number not in self._nodes:
            known = [str(each) for each in self._nodes]
            raise UnknownNameError.of("node id", str(number), known)
        self._nodes.pop(number).destroy_node()

    def nodes(self) -> dict[int, Node]:
        """Return the loaded nodes by id."""
        return dict(self._nodes)

    def _on_load(self, request: Any, response: Any) -> Any:
        try:
            number = self._load_requested(request)
        except NavetteError as error:
            response.error_message = str(error)
            return response
        node = self._nodes[number]
        if request.log_level:
            node.get_logger().set_level(request.log_level)
        response.success = True
        response.full_node_name = node.get_fully_qualified_name()
        response.unique_id = number
        return response

    def _load_requested(self, request: Any) -> int:
        arguments = _arguments_from(request)
        package, plugin = request.package_name, request.plugin_name
        try:
            return self.load(package, plugin, arguments, "load_node")
        except NavetteError:
            raise
        except Exception as error:  # a user's constructor may raise anything
            self._log.error(f"loading {plugin} failed:\n{traceback.format_exc()}")
            raise ComponentLoadError(
                f"{plugin} of {package}: {type(error).__name__}: {error}"
            ) from error

    def _on_unload(self, request: Any, response: Any) -> Any:
        try:
            self.unload(request.unique_id)
        except UnknownNameError as error:
            response.error_message = str(error)
            return response
        response.success = True
        return response

    def _on_list(self, request: Any, response: Any) -> Any:
        names = (node.get_fully_qualified_name() for node in self._nodes.values())
        response.full_node_names = list(names)
        response.unique_ids = list(self._nodes)
        return response


def _arguments_from(request: Any) -> RosArguments:
    words = ["--ros-args"]
    rules = list(request.remap_rules)
    if request.node_name:
        rules.append(f"__node:={request.node_name}")
    if request.node_namespace:
        rules.append(f"__ns:={request.node_namespace}")
    for rule in rules:
        words += ["-r", rule]
    arguments = parse_ros_arguments(words)
    for message in request.parameters:
        parameter = Parameter.from_parameter_msg(message)
        arguments.parameters.append((None, parameter.name, parameter.value))
    return arguments


@contextmanager
def _arguments_of(
    context: Context, arguments: RosArguments, origin: str
) -> Iterator[None]:
    """Give nodes created in the block these arguments, not the container's."""
    before = context.arguments, context.overrides
    context.arguments = arguments
    context.overrides = ParameterOverrides()
    context.overrides.add_arguments(arguments.parameters, origin)
    try:
        yield
    finally:
        context.arguments, context.overrides = before


def find_component(package: str, plugin: str) -> Any:
    """Return the node class of a plugin name.

    Accepted: a name registered in the entry points ``rclpy_components``,
    ``package::Class``, ``module:Class``, ``module.Class``, or a class of the package.

    Raises:
        UnknownNameError: unknown class; lists the module's node classes.
    """
    for point in entry_points(group=GROUP, name=plugin):
        return point.load()
    module, name = _split(package, plugin)
    try:
        found = getattr(importlib.import_module(module), name, None)
    except ModuleNotFoundError as error:
        raise UnknownNameError(
            f"component {plugin!r} of package {package!r}: no Python module "
            f"{error.name!r}; expected package::Class or module:Class"
        ) from error
    if not inspect.isclass(found):
        classes = [
            name
            for name, value in vars(sys.modules[module]).items()
            if inspect.isclass(value) and issubclass(value, Node)
        ]
        raise UnknownNameError.of(f"node class of {module}", name, classes)
    return found


def _split(package: str, plugin: str) -> tuple[str, str]:
    for separator in ("::", ":", "."):
        if separator in plugin:
            module, _, name = plugin.rpartition(separator)
            return module.replace("::", "."), name
    return package, plugin
