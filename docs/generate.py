"""Write docs/reference/nodes.md from the node classes: ``python docs/generate.py``.

A test compares the committed page with the generated one.
"""

import dataclasses
from pathlib import Path
from typing import Any

from navette.navigation.stack.stage_classes import node_classes
from navette.params import Params, info_of

PAGE = Path(__file__).parent / "reference" / "nodes.md"
HEAD = """# Nodes, topics and parameters

In the order data flows. Generated from the node classes by `python docs/generate.py`.
"""


def nodes_page() -> str:
    """Return the page as Markdown."""
    return "\n".join([HEAD, *(_section(name, cls) for name, cls in node_classes())])


def _section(name: str, cls: Any) -> str:
    lines = [f"## {name}", "", _first_paragraph(cls), ""]
    for title, ports in (("Subscribes", cls.INPUTS), ("Publishes", cls.OUTPUTS)):
        if ports:
            lines += [f"| {title} | type | rate (Hz) | role |", "|---|---|---|---|"]
            lines += [
                f"| `{port.topic}` | {port.type} | "
                f"{'' if port.rate_hz is None else f'{port.rate_hz:g}'} | {port.role} |"
                for port in ports
            ]
            lines.append("")
    lines += [
        "| parameter | default | unit | allowed | meaning |",
        "|---|---|---|---|---|",
    ]
    lines += [_parameter_row(field) for field in _fields(cls.PARAMS)]
    for prefix, record in cls.PARAM_GROUPS.items():
        lines += [_parameter_row(field, prefix) for field in _fields(record)]
    return "\n".join([*lines, ""])


def _fields(params: type[Params]) -> "tuple[dataclasses.Field[Any], ...]":
    return dataclasses.fields(params)


def _parameter_row(field: "dataclasses.Field[Any]", prefix: str = "") -> str:
    info = info_of(field)
    allowed = info.allowed() if info.allowed() != "any" else ""
    name = prefix + field.name
    return (
        f"| `{name}` | `{_shown(field.default)}` | {info.unit} | {allowed} "
        f"| {info.meaning} |"
    )


def _shown(value: object) -> str:
    if not isinstance(value, tuple):
        return str(value)
    if len(value) > 6 and len(set(value)) == 1:
        return f"{len(value)} × {value[0]}"
    return str(list(value))


def _first_paragraph(cls: type) -> str:
    return " ".join((cls.__doc__ or "").split("\n\n")[0].split())


if __name__ == "__main__":
    PAGE.write_text(nodes_page(), encoding="utf-8")
