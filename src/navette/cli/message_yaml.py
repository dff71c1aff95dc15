"""Format messages as YAML: as ROS 2 does in a pipe, more compact on a terminal."""

import re
import shutil
from typing import TYPE_CHECKING, Any

from navette.cli.output import harmless, is_terminal, styled

if TYPE_CHECKING:
    from navette.msgs.interface import FieldType

_KEY = re.compile(r"^([ ]*(?:- )*)([A-Za-z]\w*)(?=:)", re.MULTILINE)


def yaml_of(
    value: Any,
    field_type: "FieldType | None" = None,
    *,
    indent: int = 0,
    **shortened: Any,
) -> str:
    """Format a message, or a field that is a sequence.

    On a terminal, numbers of an array share lines, field names have a colour, and
    control characters are escaped.

    Args:
        indent: of the lines on a terminal, in characters.
        shortened: arguments of ``message_to_yaml``.
    """
    from navette.ros2.packages.rosidl_runtime_py.convert import yaml_pieces

    if not is_terminal():
        return "".join(yaml_pieces(value, field_type, **shortened))
    width = shutil.get_terminal_size().columns - indent
    pieces = yaml_pieces(value, field_type, **shortened, width=width)
    # Every second piece is an array of numbers, without text to escape or to colour.
    text = "".join(p if n % 2 else _readable(p) for n, p in enumerate(pieces))
    return re.sub("^(?=.)", " " * indent, text, flags=re.MULTILINE) if indent else text


def _readable(yaml: str) -> str:
    return _KEY.sub(lambda m: m[1] + styled(m[2], fg="cyan"), harmless(yaml))
