"""Parser of .msg, .srv and .action files.

The format is that of the ROS 2 documentation ("Interfaces"): one field or constant per
line, ``#`` starts a comment, ``---`` separates the parts of services and actions.
"""

import ast
import re
from collections.abc import Callable
from pathlib import Path

from navette.errors import FileFormatError
from navette.msgs.interface import (
    FLOATS,
    INTEGER_RANGES,
    PRIMITIVES,
    STRINGS,
    ActionSpec,
    Constant,
    Default,
    Field,
    FieldType,
    MessageSpec,
    ServiceSpec,
    Spec,
    make_action,
    make_service,
)

_PACKAGE = r"(?!.*__)[a-z][a-z0-9_]*(?<!_)"
_NAME = r"[A-Z][A-Za-z0-9]*"
PACKAGE_NAME = re.compile(_PACKAGE)
INTERFACE_NAME = re.compile(_NAME)
_FIELD_NAME = re.compile(r"(?!.*__)[a-z][a-z0-9_]*(?<!_)")
_CONSTANT_NAME = re.compile(r"[A-Z](?:[A-Z0-9_]?[A-Z0-9]+)*")
_LINE = re.compile(r"(?P<type>\S+)\s+(?P<name>\w+)\s*(?P<equals>=)?\s*(?P<value>.*)")
_TYPE = re.compile(
    r"(?P<base>[A-Za-z][\w/]*)"
    r"(?:<=(?P<bound>\d+))?"
    r"(?P<array>\[(?P<at_most><=)?(?P<size>\d+)?\])?"
)
_REFERENCE = re.compile(rf"(?:(?P<package>{_PACKAGE})/(?:msg/)?)?(?P<name>{_NAME})")
# Part of a service or action, which only definitions of their events refer to.
_PART = r"[A-Z][A-Za-z0-9]*(?:_[A-Z][A-Za-z0-9]*)+"
PART_NAME = re.compile(_PART)
_PART_REFERENCE = re.compile(
    rf"(?:(?P<package>{_PACKAGE})/(?:(?P<kind>srv|action)/)?)?(?P<name>{_PART})"
)


class _LineError(ValueError):
    """An error in a line; the caller adds file and line number."""


def parse_message(name: str, text: str, source: Path | str = "") -> MessageSpec:
    """Parse a ``.msg`` text; ``name`` is the full name, ``pkg/msg/Name``.

    Raises:
        FileFormatError: a syntax error; names the file (``source``) and the line.
    """
    (part,) = _parse(name, (name,), text, source)
    return part


def parse_service(name: str, text: str, source: Path | str = "") -> ServiceSpec:
    """Parse a ``.srv`` text; raises as :func:`parse_message` does."""
    names = (f"{name}_Request", f"{name}_Response")
    return make_service(name, *_parse(name, names, text, source))


def parse_action(name: str, text: str, source: Path | str = "") -> ActionSpec:
    """Parse an ``.action`` text; raises as :func:`parse_message` does."""
    names = (f"{name}_Goal", f"{name}_Result", f"{name}_Feedback")
    return make_action(name, *_parse(name, names, text, source))


PARSERS: dict[str, Callable[[str, str, Path | str], Spec]] = {
    "msg": parse_message,
    "srv": parse_service,
    "action": parse_action,
}
"""Parser by kind of interface."""


def _parse(
    name: str, part_names: tuple[str, ...], text: str, source: Path | str
) -> list[MessageSpec]:
    source = source or name
    members: list[list[Field | Constant]] = [[]]
    for number, raw in enumerate(text.splitlines(), start=1):
        line = without_comment(raw).strip()
        if line == "---":
            members.append([])
        elif line:
            try:
                member = _parse_line(line, name)
                _refuse_duplicate(member, members[-1])
            except _LineError as error:
                raise FileFormatError(source, str(error), number) from None
            members[-1].append(member)
    if len(members) != len(part_names):
        kind = name.split("/")[1]
        reason = f"{len(members)} parts; a .{kind} file has {len(part_names)}"
        raise FileFormatError(source, f"{reason}, separated by ---")
    return [
        MessageSpec(
            part,
            tuple(member for member in group if isinstance(member, Field)),
            tuple(member for member in group if isinstance(member, Constant)),
        )
        for part, group in zip(part_names, members, strict=True)
    ]


def without_comment(line: str) -> str:
    """Return the line up to the first ``#`` outside quotes."""
    quote = ""
    for index, character in enumerate(line):
        if quote:
            if character == quote and line[index - 1] != "\\":
                quote = ""
        elif character in "\"'":
            quote = character
        elif character == "#":
            return line[:index]
    # An unclosed quote is an apostrophe in a comment: cut at the first #.
    return line.split("#", 1)[0] if quote else line


def _refuse_duplicate(
    member: Field | Constant, earlier: list[Field | Constant]
) -> None:
    if any(member.name == other.name for other in earlier):
        raise _LineError(f"{member.name!r} is defined twice")


def _parse_line(line: str, owner: str) -> Field | Constant:
    match = _LINE.fullmatch(line)
    if match is None:
        raise _LineError(f"{line!r}: expected 'type name' or 'type NAME=value'")
    type_ = _parse_type(match["type"], owner)
    name, value = match["name"], match["value"]
    if match["equals"]:
        return _parse_constant(name, type_, value)
    if not _FIELD_NAME.fullmatch(name):
        raise _LineError(
            f"field name {name!r}: expected a lower-case letter, then "
            "lower-case letters, digits and single underscores"
        )
    if not value:
        return Field(name, type_)
    return Field(name, type_, _parse_default(name, type_, value))


def _parse_type(text: str, owner: str) -> FieldType:
    match = _TYPE.fullmatch(text)
    if match is None:
        raise _LineError(f"type {text!r}: expected base, base[], base[N] or base[<=N]")
    base = _resolve(match["base"], owner)
    bound = int(match["bound"]) if match["bound"] else None
    if bound is not None and (base not in STRINGS or bound < 1):
        raise _LineError(f"type {text!r}: only strings take a bound, at least 1")
    size = int(match["size"]) if match["size"] else None
    if not match["array"]:
        return FieldType(base, string_bound=bound)
    if size == 0 or (match["at_most"] and size is None):
        raise _LineError(f"type {text!r}: the size of an array is at least 1")
    is_array = size is not None and not match["at_most"]
    return FieldType(base, "array" if is_array else "sequence", size, bound)


def _resolve(base: str, owner: str) -> str:
    """Return the full name of a type that ``owner`` refers to."""
    if base in PRIMITIVES:
        return base
    package, kind, _ = owner.split("/")
    part = _PART_REFERENCE.fullmatch(base) if kind != "msg" else None
    if part is not None:
        return f"{part['package'] or package}/{part['kind'] or kind}/{part['name']}"
    match = _REFERENCE.fullmatch(base)
    if match is None:
        known = ", ".join(sorted(PRIMITIVES))
        raise _LineError(
            f"unknown type {base!r}: expected a message as 'pkg/Name' or one of {known}"
        )
    return f"{match['package'] or package}/msg/{match['name']}"


def _parse_constant(name: str, type_: FieldType, text: str) -> Constant:
    if not type_.is_scalar or type_.is_message:
        raise _LineError(f"constant {name!r}: type {type_} is not a primitive")
    if not _CONSTANT_NAME.fullmatch(name):
        raise _LineError(f"constant name {name!r}: expected upper case")
    if not text and not type_.is_string:
        raise _LineError(f"constant {name!r} has no value")
    value = _parse_primitive(name, type_, text)
    if type_.base == "byte":
        assert isinstance(value, int), "a byte is read as an integer"
        return Constant(name, "byte", bytes([value]))
    return Constant(name, type_.base, value)


def _parse_default(name: str, type_: FieldType, text: str) -> Default:
    if type_.is_message:
        raise _LineError(f"field {name!r}: a message cannot have a default")
    if not type_.is_scalar:
        return _parse_array(name, type_, text)
    value = _parse_primitive(name, type_, text)
    if type_.base == "byte":
        assert isinstance(value, int), "a byte is read as an integer"
        return bytes([value])
    return value


def _parse_array(
    name: str, type_: FieldType, text: str
) -> list[bool | int | float | str]:
    if not (text.startswith("[") and text.endswith("]")):
        raise _LineError(f"default of {name!r}: {text!r}, expected [value, …]")
    items = _split_items(text[1:-1])
    size = type_.size
    fits = size is None or (
        len(items) == size if type_.container == "array" else len(items) <= size
    )
    if not fits:
        raise _LineError(f"default of {name!r}: {len(items)} values for {type_}")
    return [_parse_primitive(name, type_, item) for item in items]


_ITEM = re.compile(r"""\s*("(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*'|[^,]*?)\s*(?:,|$)""")


def _split_items(text: str) -> list[str]:
    return [item for item in _ITEM.findall(text) if item] if text.strip() else []


def _parse_primitive(
    name: str, type_: FieldType, text: str
) -> bool | int | float | str:
    base = type_.base
    try:
        if base in STRINGS:
            value = _unquote(text)
            if type_.string_bound is not None and len(value) > type_.string_bound:
                raise ValueError
            return value
        if base == "bool":
            return {"true": True, "1": True, "false": False, "0": False}[text.lower()]
        if base in FLOATS:
            return float(text)
        low, high = INTEGER_RANGES["uint8" if base == "byte" else base]
        number = int(text, 0) if not text.isdecimal() else int(text)
        if not low <= number <= high:
            raise ValueError
    except (KeyError, ValueError):
        raise _LineError(
            f"value of {name!r}: {text!r} is not of type {type_}"
        ) from None
    return number


def _unquote(text: str) -> str:
    if len(text) >= 2 and text[0] == text[-1] and text[0] in "\"'":
        try:
            value = ast.literal_eval(text)
        except SyntaxError:
            raise ValueError from None
        return str(value)
    return text
