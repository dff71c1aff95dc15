"""Namespace, parameters and remappings of the nodes in a scope.

They are launch configurations of ROS 2's names, so that groups restore them.
"""

from pathlib import Path
from typing import Any

from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch_ros.utilities.namespaces import (
    make_namespace_absolute,
    prefix_namespace,
)
from navette.runtime.names import validate_namespace

_NAMESPACE = "ros_namespace"
_PARAMETERS = "global_params"
_REMAPS = "ros_remaps"

GlobalParameter = tuple[str, Any] | Path
"""(name, value), or a parameter file."""


def push_namespace(context: LaunchContext, namespace: str) -> None:
    """Add a namespace; one that starts with ``/`` is absolute."""
    context.launch_configurations[_NAMESPACE] = scoped_namespace(context, namespace)


def scoped_namespace(context: LaunchContext, own: str | None) -> str | None:
    """Return a node's full namespace; None if neither it nor the scope has one."""
    given = None if own is None else own.strip()
    outer = context.launch_configurations.get(_NAMESPACE)
    namespace = make_namespace_absolute(prefix_namespace(outer, given))
    if namespace is not None:
        validate_namespace(namespace)
    return namespace


def global_parameters(context: LaunchContext) -> list[GlobalParameter]:
    """Return the parameters and parameter files of the scope."""
    found = context.launch_configurations.get(_PARAMETERS, ())
    return [item if isinstance(item, tuple) else Path(item) for item in found]


def add_global_parameter(context: LaunchContext, given: tuple[str, Any] | str) -> None:
    """Add (name, value), or the path of a parameter file."""
    _append(context, _PARAMETERS, given)


def global_remaps(context: LaunchContext) -> list[tuple[str, str]]:
    """Return the remappings of the scope."""
    return list(context.launch_configurations.get(_REMAPS, ()))


def add_global_remap(context: LaunchContext, source: str, target: str) -> None:
    _append(context, _REMAPS, (source, target))


def _append(context: LaunchContext, name: str, item: object) -> None:
    # A new list: that of the outer scope is restored unchanged.
    known = context.launch_configurations.get(name, ())
    context.launch_configurations[name] = [*known, item]
