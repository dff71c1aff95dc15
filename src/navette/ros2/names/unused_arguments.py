"""What was given to a program and reaches none of its nodes: said, not passed over.

As warnings: a node may declare parameters, and make topics, long after it began.
"""

from collections.abc import Sequence

from navette.errors import ParameterError
from navette.runtime import Context, Node
from navette.runtime.names import NodeRemapper, RemapRule
from navette.runtime.override_check import check_reached


def warn_of_leftovers(context: Context) -> None:
    """To be called on the context's loop, once its nodes are made."""
    nodes = list(context.nodes)
    if not nodes:
        return
    log = nodes[0].get_logger()
    try:
        check_reached(context.overrides, nodes)
    except ParameterError as error:
        log.warning(str(error))
    for rule in context.arguments.remaps:
        if not rule.match.startswith("__") and not _is_used(rule, nodes):
            names = sorted({name for node in nodes for name in _names(node)})
            log.warning(
                f"remapping {rule.match}:={rule.replacement}: nothing was called so; "
                f"there is {', '.join(names) or 'no topic or service'}"
            )


def _is_used(rule: RemapRule, nodes: Sequence[Node]) -> bool:
    return any(_reaches(rule, node) for node in nodes)


def _reaches(rule: RemapRule, node: Node) -> bool:
    """Whether the node has something of the new name (or below it, as an action)."""
    name, namespace = node.get_name(), node.get_namespace()
    target = NodeRemapper([], name, namespace).resolve(rule.replacement)
    return any(
        each == target or each.startswith(f"{target}/_action/")
        for each in _names(node, with_hidden=True)
    )


def _names(node: Node, *, with_hidden: bool = False) -> list[str]:
    """What the node made itself: not what every node has."""
    graph = node.context.graph
    full = node.get_fully_qualified_name()
    every = [*graph.endpoints(), *graph.service_endpoints()]
    found = [each.topic for each in every if each.node_full_name == full]
    own = (f"{full}/", "/rosout", "/parameter_events")
    return [
        name
        for name in found
        if with_hidden or not (name.startswith(own) or "/_action/" in name)
    ]
