"""Format parameters as ``ros2 param`` does."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from navette.cli.output import aligned, cut_to_width, harmless, styled

if TYPE_CHECKING:
    from navette.runtime import Parameter

_LABELS = {
    "BOOL": "Boolean value is:",
    "INTEGER": "Integer value is:",
    "DOUBLE": "Double value is:",
    "STRING": "String value is:",
    "BYTE_ARRAY": "Byte values are:",
    "BOOL_ARRAY": "Boolean values are:",
    "INTEGER_ARRAY": "Integer values are:",
    "DOUBLE_ARRAY": "Double values are:",
    "STRING_ARRAY": "String values are:",
}


def labelled(parameter: "Parameter[Any]") -> str:
    """Format a value as ``ros2 param get`` does."""
    label = _LABELS.get(parameter.type_.name)
    return f"{label} {parameter.value}" if label else "Parameter not set."


def plain(parameter: "Parameter[Any]") -> Any:
    """Return the value for JSON; bytes become numbers."""
    value = parameter.value
    if isinstance(value, list):
        return [item[0] if isinstance(item, bytes) else item for item in value]
    return value


def type_word(kind: int) -> str:
    """Return ``string array`` for STRING_ARRAY, as ROS 2's command prints it."""
    from navette.runtime.parameter import ParameterType

    name: str = ParameterType(kind).name.lower().replace("_", " ")
    return name.replace("bool", "boolean")


def descriptor_dict(descriptor: Any) -> dict[str, Any]:
    limits = _limits(descriptor)
    return {
        "name": descriptor.name,
        "type": type_word(descriptor.type),
        "description": descriptor.description,
        "read_only": descriptor.read_only,
        "additional_constraints": descriptor.additional_constraints,
        **(
            {"min": limits.from_value, "max": limits.to_value, "step": limits.step}
            if limits
            else {}
        ),
    }


def descriptor_lines(descriptor: Any) -> list[str]:
    """Format a descriptor as ``ros2 param describe`` does, without the name."""
    lines = [f"  Type: {type_word(descriptor.type)}"]
    if descriptor.description:
        lines.append(f"  Description: {descriptor.description}")
    lines.append("  Constraints:")
    if descriptor.read_only:
        lines.append("    Read only: true")
    if limits := _limits(descriptor):
        lines.append(f"    Min value: {limits.from_value}")
        lines.append(f"    Max value: {limits.to_value}")
        if limits.step:
            lines.append(f"    Step: {limits.step}")
    if descriptor.additional_constraints:
        lines.append(f"    Additional constraints: {descriptor.additional_constraints}")
    return lines


def _limits(descriptor: Any) -> Any:
    ranges = [*descriptor.floating_point_range, *descriptor.integer_range]
    return ranges[0] if ranges else None


def name_lines(
    found: dict[str, list[str]],
    kinds: dict[tuple[str, str], str],
    shown_values: dict[tuple[str, str], str],
    *,
    with_nodes: bool,
) -> Iterator[str]:
    """Yield a line per name, on a terminal with the values in columns.

    Args:
        found: names by node.
        kinds: types by (node, name); empty: not printed.
        shown_values: values by (node, name); empty: not printed.
    """
    for node, names in found.items():
        if with_nodes and names:
            yield styled(f"{node}:", bold=True)
        if not shown_values:
            for name in names:
                kind = f" (type: {kinds[node, name]})" if kinds else ""
                yield harmless(f"  {name}{kind}")
            continue
        rows = [
            (name, *([kinds[node, name]] if kinds else []), shown_values[node, name])
            for name in names
        ]
        width = max(map(len, names), default=0)
        for line in aligned(rows):
            text = cut_to_width(harmless(f"  {line}"))
            yield text[: width + 2] + styled(text[width + 2 :], dim=True)
