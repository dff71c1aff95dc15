"""Messages as YAML: in a pipe as ROS 2 prints them, on a terminal for people."""

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
    """A message, or a sequence that is a field of one.

    For a person the numbers of an array stand beside each other and names apart from
    values, and what others sent does not act on the terminal.

    Args:
        indent: of a person's lines, in characters.
        shortened: as of ``message_to_yaml``.
    """
    from navette.ros2.packages.rosidl_runtime_py.convert import yaml_pieces

    if not is_terminal():
        return "".join(yaml_pieces(value, field_type, **shortened))
    width = shutil.get_terminal_size().columns - indent
    pieces = yaml_pieces(value, field_type, **shortened, width=width)
    # Arrays of numbers, every second piece, have nothing to escape or to colour.
    text = "".join(p if n % 2 else _readable(p) for n, p in enumerate(pieces))
    return re.sub("^(?=.)", " " * indent, text, flags=re.MULTILINE) if indent else text


def _readable(yaml: str) -> str:
    return _KEY.sub(lambda m: m[1] + styled(m[2], fg="cyan"), harmless(yaml))
