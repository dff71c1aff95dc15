"""Definitions as ``ros2msg`` text, the schema encoding of MCAP files and Foxglove."""

import json

from navette.msgs.interface import (
    ActionSpec,
    Constant,
    Field,
    MessageSpec,
    ServiceSpec,
    Spec,
    short_name,
)
from navette.msgs.registry import get_message_spec, get_spec

_SEPARATOR = "=" * 80


def definition_text(name: str) -> str:
    """Return the definition and those of all contained messages, each under ``MSG:``.

    The parts of services and actions are separated by ``---``, as in their files.
    """
    tops = _tops(get_spec(name))
    contained: dict[str, MessageSpec] = {}
    for top in tops:
        _collect(top, contained)
    text = _joined(tops)
    for dependency in contained.values():
        text += f"{_SEPARATOR}\nMSG: {short_name(dependency.name)}\n"
        text += message_text(dependency)
    return text


def interface_text(name: str) -> str | None:
    """Return the text of the interface's file, without comments.

    None for a part of a service or action, which has no file.
    """
    spec = get_spec(name)
    kinds = {MessageSpec: "msg", ServiceSpec: "srv", ActionSpec: "action"}
    has_file = spec.name.split("/")[1] == kinds[type(spec)]
    return _joined(_tops(spec)) if has_file else None


def _tops(spec: Spec) -> list[MessageSpec]:
    """The message itself, or the parts in the file of a service or action."""
    if isinstance(spec, MessageSpec):
        return [spec]
    if isinstance(spec, ServiceSpec):
        return [spec.request, spec.response]
    return [spec.goal, spec.result, spec.feedback]


def _joined(parts: list[MessageSpec]) -> str:
    return "---\n".join(message_text(part) for part in parts)


def message_text(spec: MessageSpec) -> str:
    """Return constants, then fields, one per line, as in a ``.msg`` file."""
    lines = [_constant_line(constant) for constant in spec.constants]
    lines += [_field_line(field) for field in spec.fields]
    return "".join(line + "\n" for line in lines)


def _collect(spec: MessageSpec, found: dict[str, MessageSpec]) -> None:
    for field in spec.fields:
        if field.type.is_message and field.type.base not in found:
            found[field.type.base] = get_message_spec(field.type.base)
            _collect(found[field.type.base], found)


def _constant_line(constant: Constant) -> str:
    return f"{constant.base} {constant.name}={_literal(constant.value)}"


def _field_line(field: Field) -> str:
    line = f"{field.type} {field.name}"
    if field.default is None:
        return line
    if isinstance(field.default, list):
        return f"{line} [{', '.join(_literal(item) for item in field.default)}]"
    return f"{line} {_literal(field.default)}"


def _literal(value: bool | int | float | str | bytes) -> str:
    if isinstance(value, bytes):
        return str(value[0])
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    return repr(value)
