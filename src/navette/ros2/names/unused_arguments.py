"""Warnings of ROS arguments (parameters, remappings) that affect no node.

They are not errors: a node may still declare parameters and create topics later.
"""

from collections.abc import Sequence

from navette.errors import ParameterError
from navette.runtime import Context, Node
from navette.runtime.names import NodeRemapper, RemapRule


def warn_of_unused_arguments(context: Context) -> None:
    """Log a warning for each unused argument; to be called on the context's loop."""
    nodes = list(context.nodes)
    if not nodes:
        return
    log = nodes[0].get_logger()
    try:
        context.overrides.check_used_by(nodes)
    except ParameterError as error:
        log.warning(str(error))
    for rule in context.arguments.remaps:
        if not rule.match.startswith("__") and not _is_used(rule, nodes):
            names = sorted({name for node in nodes for name in _own_names(node)})
            log.warning(
                f"remapping {rule.match}:={rule.replacement} matches no name of the "
                f"program's nodes; their names: "
                f"{', '.join(names) or 'no topic or service'}"
            )


def _is_used(rule: RemapRule, nodes: Sequence[Node]) -> bool:
    return any(_matches(rule, node) for node in nodes)


def _matches(rule: RemapRule, node: Node) -> bool:
    """Whether the node has the new name, as a topic, service or action."""
    name, namespace = node.get_name(), node.get_namespace()
    target = NodeRemapper([], name, namespace).resolve(rule.replacement)
    return any(
        each == target or each.startswith(f"{target}/_action/") for each in _names(node)
    )


def _own_names(node: Node) -> list[str]:
    common = (f"{node.get_fully_qualified_name()}/", "/rosout", "/parameter_events")
    return [
        name
        for name in _names(node)
        if not (name.startswith(common) or "/_action/" in name)
    ]


def _names(node: Node) -> list[str]:
    graph = node.context.graph
    full_name = node.get_fully_qualified_name()
    endpoints = [*graph.endpoints(), *graph.service_endpoints()]
    return [each.topic for each in endpoints if each.node_full_name == full_name]
