"""Parameters given to a program that is one node of several."""

from collections import defaultdict

from navette.runtime import Node
from navette.runtime.overrides import OverrideSet, ParameterOverrides


def check_reached(overrides: ParameterOverrides, node: Node) -> None:
    """Raise for values that were meant for this node and do not reach it.

    A parameter file is often that of the whole stack: entries for others are theirs,
    but a file without any entry for this node was given in vain. What a file's
    ``/**`` says need not be known to every node.

    Raises:
        ParameterError: names file or argument, and the known names.
    """
    by_origin: dict[str, list[OverrideSet]] = defaultdict(list)
    for each in overrides.sets:
        by_origin[each.origin].append(each)
    name = node.get_fully_qualified_name()
    checked = ParameterOverrides()
    for sets in by_origin.values():
        own = [each for each in sets if each.matches(name)]
        is_file = len(sets) > 1 or sets[0].names_a_node
        checked.sets += own if not is_file else [] if own else sets
    checked.check([node])
