"""The container of composable nodes: loads node classes, runs them on one loop.

A program like any other; it reads what to load from its standard input, a line of
JSON each: ``{"package": …, "plugin": …, "arguments": [ROS arguments]}``.
"""

import importlib
import inspect
import json
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from importlib.metadata import entry_points
from typing import Any

from navette import runtime
from navette.bringup.programs import program_input
from navette.errors import UnknownNameError
from navette.runtime import Context, Executor, Node
from navette.runtime.arguments import parse_ros_arguments
from navette.runtime.context import get_default_context
from navette.runtime.overrides import ParameterOverrides

GROUP = "rclpy_components"


def main() -> None:
    """Load what is asked for, until the end."""
    runtime.init()
    context = get_default_context()
    executor = Executor(context=context)
    executor.add_node(Node("component_container"))
    threading.Thread(target=_listen, args=(executor,), daemon=True).start()
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass  # the way to end it
    finally:
        runtime.try_shutdown()


def _listen(executor: Executor) -> None:
    """Hand each request to the loop, which may load it between two callbacks."""
    for line in _lines():
        executor.call_soon_threadsafe(partial(_load, executor, json.loads(line)))


def _lines() -> Iterator[bytes]:
    pieces = program_input.get()
    if pieces is None:
        yield from sys.stdin.buffer
        return
    while True:
        yield pieces.get()


def _load(executor: Executor, request: dict[str, Any]) -> None:
    context = executor.context
    node_class = find_component(request["package"], request["plugin"])
    before = list(context.nodes)
    with _arguments_of(context, request["arguments"]):
        takes_context = "context" in inspect.signature(node_class).parameters
        node = node_class(context=context) if takes_context else node_class()
        context.check_overrides([n for n in context.nodes if n not in before])
    executor.add_node(node)
    node.get_logger().info(
        f"loaded {request['plugin']} as {node.get_fully_qualified_name()}"
    )


@contextmanager
def _arguments_of(context: Context, words: list[str]) -> Iterator[None]:
    """Let the nodes made meanwhile have these arguments instead of the container's."""
    before = context.arguments, context.overrides
    context.arguments = parse_ros_arguments(["--ros-args", *words])
    context.overrides = ParameterOverrides()
    context.overrides.add_arguments(context.arguments.parameters, "launch file")
    try:
        yield
    finally:
        context.arguments, context.overrides = before


def find_component(package: str, plugin: str) -> Any:
    """The node class that a plugin's name means.

    A name registered in the entry points ``rclpy_components``; ``package::Class`` of
    the package's own module; ``module:Class`` or ``module.Class``.

    Raises:
        UnknownNameError: there is no such class; says what was looked for.
    """
    for point in entry_points(group=GROUP, name=plugin):
        return point.load()
    module, name = _split(package, plugin)
    try:
        found = getattr(importlib.import_module(module), name, None)
    except ModuleNotFoundError as error:
        raise UnknownNameError(
            f"component {plugin!r} of package {package!r}: no Python module "
            f"{error.name!r}; wanted package::Class or module:Class"
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
