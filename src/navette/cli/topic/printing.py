"""Messages as text on a terminal or in a pipe: YAML, CSV, JSON, raw."""

import re
import shutil
from typing import Any

from navette.cli.output import harmless, is_terminal, json_text, styled
from navette.cli.topic.field_path import FieldPath
from navette.cli.topic.style import Style
from navette.companions.rosidl_runtime_py.convert import (
    message_to_csv,
    message_to_yaml,
    value_to_csv,
    value_to_yaml,
)
from navette.msgs import Message, to_dict

SEPARATOR = "---"
_NUMBER = r"(?:-?(?:\.inf|\.nan|\d[\d.]*(?:e[+-]?\d+)?)|true|false|'\.\.\.')"
_NUMBERS = re.compile(
    rf"(?P<key>^ *(?:- )*\w+:|\A)\n?(?P<items>(?: *- {_NUMBER}\n)+)", re.MULTILINE
)
_KEY = re.compile(r"^([ ]*(?:- )*)([A-Za-z]\w*)(?=:)", re.MULTILINE)


def text_of(value: Any, field: FieldPath | None, style: Style) -> str:
    """A message, or the part of one that ``field`` leads to."""
    if style.as_json:
        return json_text(_jsonable(value))
    if style.csv:
        return harmless(_csv(value, field, style))
    return f"{_yaml(value, field, style)}{styled(SEPARATOR, dim=True)}"


def _csv(value: Any, field: FieldPath | None, style: Style) -> str:
    shortened = _shortened(style)
    if isinstance(value, Message):
        return message_to_csv(value, **shortened)
    assert field is not None, "a message itself is a Message"
    return value_to_csv(value, field.type, **shortened)


def _yaml(value: Any, field: FieldPath | None, style: Style) -> str:
    shortened = {**_shortened(style), "flow_style": style.flow_style}
    if isinstance(value, Message):
        return _readable(message_to_yaml(value, **shortened))
    assert field is not None, "a message itself is a Message"
    if field.type.is_scalar:
        return harmless(value_to_csv(value, field.type)) + "\n"
    return _readable(value_to_yaml(value, field.type, **shortened))


def _shortened(style: Style) -> dict[str, Any]:
    return {
        "truncate_length": None if style.full_length else style.truncate_length,
        "no_arr": style.no_arr,
        "no_str": style.no_str,
    }


def _jsonable(value: Any) -> Any:
    if isinstance(value, Message):
        return to_dict(value)
    if isinstance(value, bytes):
        return value[0]
    if isinstance(value, list):
        return [_jsonable(item) for item in value]
    return value.tolist() if hasattr(value, "tolist") else value


def _readable(yaml: str) -> str:
    """For a person: numbers of an array beside each other, names apart from values."""
    if not is_terminal():
        return yaml
    yaml = _NUMBERS.sub(_in_rows, harmless(yaml))
    return _KEY.sub(lambda m: m[1] + styled(m[2], fg="cyan"), yaml)


def _in_rows(match: re.Match[str]) -> str:
    """Numbers beside each other, in lines that end between two of them."""
    items = [line.strip().removeprefix("- ") for line in match["items"].splitlines()]
    key = f"{match['key']} [" if match["key"] else "["
    room = shutil.get_terminal_size().columns
    indent = " " * len(key)
    lines, line = [], f"{key}{items[0]}"
    for item in items[1:]:
        if len(line) + len(item) + 3 > room:
            lines.append(f"{line},\n")
            line = f"{indent}{item}"
        else:
            line += f", {item}"
    return f"{''.join(lines)}{line}]\n"
