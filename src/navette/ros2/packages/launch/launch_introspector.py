"""Text representation of launch descriptions."""

from navette.ros2.packages.launch.launch_description import LaunchDescription
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
)


class LaunchIntrospector:
    """Formats launch descriptions."""

    def format_launch_description(self, launch_description: LaunchDescription) -> str:
        """Format a description as a tree, one line per entity."""
        return "\n".join(_lines(launch_description, ""))


def _lines(entity: LaunchDescriptionEntity, indent: str) -> list[str]:
    inside = list(entity.describe_sub_entities())
    for _, entities in entity.describe_conditional_sub_entities():
        inside += entities
    lines = [indent + entity.describe()]
    for position, each in enumerate(inside):
        is_last = position == len(inside) - 1
        first, *rest = _lines(each, "")
        lines.append(f"{indent}{'└── ' if is_last else '├── '}{first}")
        lines += [f"{indent}{'    ' if is_last else '│   '}{line}" for line in rest]
    return lines
