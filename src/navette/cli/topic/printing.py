"""Format messages as YAML, CSV or JSON."""

from collections.abc import Sequence
from typing import Any

from navette.cli.message_yaml import yaml_of
from navette.cli.output import harmless, json_text, styled
from navette.cli.topic.echo_options import Style
from navette.msgs import Message, to_dict
from navette.msgs.field_path import FieldPath
from navette.ros2.packages.rosidl_runtime_py.convert import (
    message_to_csv,
    value_to_csv,
)

SEPARATOR = "---"
Part = tuple[FieldPath, Any]


def text_of(message: Any, parts: Sequence[Part], style: Style) -> str:
    """Format a message, or only the selected fields."""
    if style.as_json:
        return json_text(_json_of(message, parts))
    if style.csv:
        texts = [_csv(value, field, style) for field, value in parts]
        return harmless(
            ",".join(texts) if parts else message_to_csv(message, **_shortened(style))
        )
    texts = [_yaml(value, field, style) for field, value in parts]
    if not parts:
        texts = [_yaml(message, None, style)]
    return f"{''.join(texts)}{styled(SEPARATOR, dim=True)}"


def _json_of(message: Any, parts: Sequence[Part]) -> Any:
    """Return the message or the single field; several fields by their paths."""
    if len(parts) < 2:
        return _jsonable(parts[0][1] if parts else message)
    return {field.text: _jsonable(value) for field, value in parts}


def _csv(value: Any, field: FieldPath, style: Style) -> str:
    return value_to_csv(value, field.type, **_shortened(style))


def _yaml(value: Any, field: FieldPath | None, style: Style) -> str:
    if field is not None and field.type.is_scalar and not field.type.is_message:
        return harmless(value_to_csv(value, field.type)) + "\n"
    return yaml_of(
        value,
        None if field is None else field.type,
        **_shortened(style),
        flow_style=style.flow_style,
    )


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
