"""Conversion of ROS 1 definitions to ROS 2, to read ROS 1 recordings.

Source: wiki.ros.org/msg (the format), docs.ros.org "Changes between ROS 1 and ROS 2"
(names, ``time``, ``duration``, ``Header`` without ``seq``). Serialised data keeps its
order: the result has the fields of the original, except ``seq``.
"""

import json
import re

from navette.errors import FileFormatError
from navette.msgs.definition_sections import split_sections
from navette.msgs.interface import PRIMITIVES

_SEPARATOR = "=" * 80
_BUILTIN = {
    "time": "builtin_interfaces/Time",
    "duration": "builtin_interfaces/Duration",
    "Header": "std_msgs/Header",
}
# Same type, another name in ROS 2.
_RENAMED = {"tf/tfMessage": "tf2_msgs/TFMessage"}
_SECTIONS = {
    "std_msgs/Header": "builtin_interfaces/Time stamp\nstring frame_id\n",
    "builtin_interfaces/Time": "int32 sec\nuint32 nanosec\n",
    "builtin_interfaces/Duration": "int32 sec\nuint32 nanosec\n",
}
_CONSTANT = re.compile(r"(?P<type>\w+)\s+(?P<name>\w+)\s*=(?P<value>.*)")
_FIELD = re.compile(r"(?P<base>[A-Za-z][\w/]*)(?P<array>\[\d*\])?\s+(?P<name>\w+)")
_CONSTANT_NAME = re.compile(r"[A-Z](?:[A-Z0-9_]?[A-Z0-9]+)*")


def ros1_definition(type_name: str, text: str) -> tuple[str, str]:
    """Return the ROS 2 name and ``ros2msg`` text of a ROS 1 type.

    Args:
        type_name: ``pkg/Type``.
        text: as in a ROS 1 bag: the type's own text, then each contained type under
            ``MSG: pkg/Type``.

    Names that are invalid in ROS 2 are converted (``D`` → ``d``, ``tf/tfMessage`` →
    ``tf2_msgs/msg/TFMessage``); constants with invalid names are dropped.

    Raises:
        FileFormatError: the text is malformed or too large.
    """
    source = f"ROS 1 definition of {type_name}"
    sections: dict[str, str] = {}
    for short, body in split_sections(type_name, text, source):
        name = _type_name(short, source)
        if name not in sections:
            sections[name] = _SECTIONS.get(name) or _message_text(short, body, source)
    for name, body in _SECTIONS.items():  # Header first: it contains a Time
        if any(f"{name} " in f" {each}" for each in sections.values()):
            sections[name] = body
    top, *contained = sections
    full = top.replace("/", "/msg/")
    return full, sections[top] + "".join(
        f"{_SEPARATOR}\nMSG: {name}\n{sections[name]}" for name in contained
    )


def _message_text(short: str, text: str, source: str) -> str:
    package = short.partition("/")[0]
    lines: list[str] = []
    taken: set[str] = set()
    for number, raw in enumerate(text.splitlines(), start=1):
        constant = _CONSTANT.fullmatch(raw.strip())
        if constant is not None and "#" not in raw.partition("=")[0]:
            lines += _constant_line(constant)
            continue
        line = raw.partition("#")[0].strip()
        if not line:
            continue
        field = _FIELD.fullmatch(line)
        if field is None:
            reason = f"{line[:80]!r}: expected 'type name' or 'type NAME=value'"
            raise FileFormatError(f"{source}: {short}", reason, number)
        base = _base(field["base"], package, source)
        name = _field_name(field["name"], taken)
        lines.append(f"{base}{field['array'] or ''} {name}")
    return "".join(line + "\n" for line in lines)


def _constant_line(constant: re.Match[str]) -> list[str]:
    type_, name, value = constant.group("type", "name", "value")
    if type_ not in PRIMITIVES or not _CONSTANT_NAME.fullmatch(name):
        return []
    if type_ == "string":  # extends to the end of the line, including any #
        return [f"string {name}={json.dumps(value.strip(), ensure_ascii=False)}"]
    value = value.partition("#")[0].strip()
    return [f"{type_} {name}={value}"]


def _base(base: str, package: str, source: str) -> str:
    if base in PRIMITIVES:
        return base
    if base in _BUILTIN:
        return _BUILTIN[base]
    return _type_name(base if "/" in base else f"{package}/{base}", source)


def _type_name(short: str, source: str) -> str:
    """Convert ``pkg/Type`` to a valid ROS 2 name."""
    if short in _RENAMED:
        return _RENAMED[short]
    package, slash, name = short.partition("/")
    if not slash or not re.fullmatch(r"\w+", package) or not re.fullmatch(r"\w+", name):
        raise FileFormatError(
            source, f"{short[:80]!r} is not a type name: expected pkg/Type"
        )
    words = [word[0].upper() + word[1:] for word in name.split("_") if word]
    return f"{re.sub('_+', '_', package).strip('_').lower()}/{''.join(words)}"


def _field_name(name: str, taken: set[str]) -> str:
    """Convert to a valid ROS 2 field name that is not in ``taken``; add it there."""
    words = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
    base = re.sub("_+", "_", words).strip("_") or "field"
    if not base[0].isalpha():
        base = f"field_{base}"
    found, number = base, 2
    while found in taken:
        found, number = f"{base}{number}", number + 1
    taken.add(found)
    return found
