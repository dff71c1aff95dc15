"""Check that each parameter file matches a node of the launch."""

from pathlib import Path
from typing import Any

from navette.errors import ParameterError
from navette.ros2.packages.launch.errors import LaunchError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.runtime.names import full_node_name
from navette.runtime.overrides import OverrideSet
from navette.runtime.parameter_files import read_parameter_file

_NOTE = "parameter files"


def check_later(context: LaunchContext, node: Any, files: list[Path]) -> None:
    """Check the parameter files of a node after the visit of the description."""
    if _NOTE not in context.notes:
        context.notes[_NOTE] = []
        context.loop.call_soon(lambda: _check(context), "parameter files")
    entries: list[tuple[Any, Path]] = context.notes[_NOTE]
    entries += [(node, file) for file in files]


def _check(context: LaunchContext) -> None:
    entries: list[tuple[Any, Path]] = context.notes.pop(_NOTE)
    for path in dict.fromkeys(path for _, path in entries):
        nodes = [node for node, each in entries if each == path]
        patterns = [pattern for pattern, _ in read_parameter_file(path)]
        # Without a given name, the program chooses the node's name.
        if any(node.expanded_node_name[0] == "<" for node in nodes):
            continue
        names = [_full_name(node) for node in nodes]
        if not any(_matches(pattern, name) for pattern in patterns for name in names):
            error = ParameterError(
                f"{path}: has no parameters for {', '.join(names)}; it has some for "
                f"{', '.join(patterns) or 'no node'}"
            )
            raise LaunchError.at(nodes[0].origin, nodes[0].describe(), error)


def _matches(pattern: str, name: str) -> bool:
    return OverrideSet("/" + pattern.strip("/"), {}, "").matches(name)


def _full_name(node: Any) -> str:
    namespace: str = node.expanded_node_namespace
    return full_node_name(
        node.expanded_node_name, "" if "<" in namespace else namespace
    )
