"""Messages as text on a terminal or in a pipe: YAML, CSV, JSON, raw."""

import re
import shutil
from dataclasses import dataclass
from typing import Any

from navette.cli.output import harmless, is_terminal, json_text, styled
from navette.cli.topic.field_path import FieldPath
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


@dataclass(frozen=True, kw_only=True)
class Style:
    """How messages are printed; lengths in items or characters, None = whole."""

    csv: bool = False
    as_json: bool = False
    truncate_length: int | None = 128
    no_arr: bool = False
    no_str: bool = False
    flow_style: bool = False

    def text(self, value: Any, field: FieldPath | None) -> str:
        """A message, or the part of one that ``field`` leads to."""
        if self.as_json:
            return json_text(_jsonable(value))
        if self.csv:
            return harmless(self._csv(value, field))
        return f"{self._yaml(value, field)}{styled(SEPARATOR, dim=True)}"

    def _csv(self, value: Any, field: FieldPath | None) -> str:
        shortened = self._shortened()
        if isinstance(value, Message):
            return message_to_csv(value, **shortened)
        assert field is not None, "a message itself is a Message"
        return value_to_csv(value, field.type, **shortened)

    def _yaml(self, value: Any, field: FieldPath | None) -> str:
        shortened = {**self._shortened(), "flow_style": self.flow_style}
        if isinstance(value, Message):
            return _readable(message_to_yaml(value, **shortened))
        assert field is not None, "a message itself is a Message"
        if field.type.is_scalar:
            return harmless(value_to_csv(value, field.type)) + "\n"
        return _readable(value_to_yaml(value, field.type, **shortened))

    def _shortened(self) -> dict[str, Any]:
        return {
            "truncate_length": self.truncate_length,
            "no_arr": self.no_arr,
            "no_str": self.no_str,
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
