"""Parameters given to a program whose nodes are some of several."""

from collections import defaultdict
from collections.abc import Sequence

from navette.runtime import Node
from navette.runtime.overrides import OverrideSet, ParameterOverrides


def check_reached(overrides: ParameterOverrides, nodes: Sequence[Node]) -> None:
    """Raise for values that were meant for these nodes and do not reach them.

    A parameter file is often that of the whole stack: entries for others are theirs,
    but a file without any entry for these nodes was given in vain. What a file's
    ``/**`` says need not be known to every node.

    Raises:
        ParameterError: names file or argument, and the known names.
    """
    by_origin: dict[str, list[OverrideSet]] = defaultdict(list)
    for each in overrides.sets:
        by_origin[each.origin].append(each)
    names = [node.get_fully_qualified_name() for node in nodes]
    checked = ParameterOverrides()
    for sets in by_origin.values():
        own = [each for each in sets if any(map(each.matches, names))]
        is_file = len(sets) > 1 or sets[0].names_a_node
        named = [each for each in own if each.names_a_node or not is_file]
        checked.sets += named if own else sets
    checked.check(nodes)
