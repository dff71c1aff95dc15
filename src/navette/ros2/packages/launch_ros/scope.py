"""Namespace, parameters and remappings of the nodes in a scope.

They are stored as launch configurations, so that groups restore them.
"""

import json
from pathlib import Path
from typing import Any

from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.runtime.names import normalize_namespace, validate_namespace

_NAMESPACE = "ros_namespace"
_PARAMETERS = "navette global parameters"
_REMAPS = "navette global remaps"

GlobalParameter = tuple[str, Any] | Path
"""(name, value), or a parameter file."""


def pushed_namespace(context: LaunchContext) -> str:
    """Return the namespace of the scope; empty if none is set."""
    return context.launch_configurations.get(_NAMESPACE, "")


def push_namespace(context: LaunchContext, namespace: str) -> None:
    """Add a namespace; one that starts with ``/`` is absolute."""
    context.launch_configurations[_NAMESPACE] = joined_namespace(
        pushed_namespace(context), namespace
    )


def joined_namespace(outer: str, inner: str) -> str:
    """Join namespaces; an absolute ``inner`` (``/…``) stays as it is."""
    inner = inner.strip()
    if not inner.startswith("/"):
        inner = f"{outer.rstrip('/')}/{inner}" if outer else inner
    if not inner:
        return ""
    namespace = normalize_namespace(inner)
    validate_namespace(namespace)
    return namespace


def global_parameters(context: LaunchContext) -> list[GlobalParameter]:
    """Return the parameters and parameter files of the scope."""
    found = json.loads(context.launch_configurations.get(_PARAMETERS, "[]"))
    return [
        Path(item) if isinstance(item, str) else (item[0], item[1]) for item in found
    ]


def add_global_parameter(context: LaunchContext, given: GlobalParameter) -> None:
    found = [*global_parameters(context), given]
    context.launch_configurations[_PARAMETERS] = json.dumps(
        [str(item) if isinstance(item, Path) else item for item in found]
    )


def global_remaps(context: LaunchContext) -> list[tuple[str, str]]:
    """Return the remappings of the scope."""
    found = json.loads(context.launch_configurations.get(_REMAPS, "[]"))
    return [(source, target) for source, target in found]


def add_global_remap(context: LaunchContext, source: str, target: str) -> None:
    context.launch_configurations[_REMAPS] = json.dumps(
        [*global_remaps(context), (source, target)]
    )
