"""Counts of the names of the nodes that a launch has started or loaded."""

from collections import Counter

from navette.ros2.packages.launch.launch_context import LaunchContext

_LOCAL = "unique_ros_node_names"


def add_node_name(context: LaunchContext, node_name: str) -> None:
    """Count another node of this full name."""
    counts = context.get_locals_as_dict().get(_LOCAL)
    if counts is None:
        counts = Counter()
        context.extend_globals({_LOCAL: counts})
    counts[node_name] += 1


def get_node_name_count(context: LaunchContext, node_name: str) -> int:
    """Return how many nodes of this full name the launch has made."""
    counts: Counter[str] = context.get_locals_as_dict().get(_LOCAL, Counter())
    return counts[node_name]


def repeated_name_warning(context: LaunchContext, node_name: str) -> str:
    """Return the warning that a name is not unique; empty if it is."""
    count = get_node_name_count(context, node_name)
    if count < 2:
        return ""
    return (
        f"there are now at least {count} nodes with the name {node_name} created "
        "within this launch context"
    )
