"""Parser of ``ros2msg`` text: a type's definition, then those of contained types.

The format is that of MCAP schemas: the type's own text, then for each type that it
refers to a line of ``=``, ``MSG: package/Name`` and that type's text. rosbag2 stores
the events of a service as ``SRV: package/srv/Name`` with the text of the service, and
those of an action as ``ACTION: …``. The text comes from files and from the network, so
its size and nesting are limited.
"""

import re
from collections.abc import Sequence

from navette.errors import FileFormatError, UnknownNameError
from navette.msgs.interface import MessageSpec, Spec
from navette.msgs.parser import (
    INTERFACE_NAME,
    PACKAGE_NAME,
    PARSERS,
    PART_NAME,
    parse_message,
)
from navette.msgs.registry import full_name, get_message_spec

MAX_CHARACTERS = 1 << 20
MAX_SECTIONS = 500
MAX_LINES = 4096  # of a section
MAX_FIELDS = 1 << 16  # of the type and all contained types, arrays expanded
MAX_BYTES = 1 << 26  # of its fixed-size arrays of numbers
MAX_DEPTH = 32

_MARKS = {"MSG": "msg", "SRV": "srv", "ACTION": "action"}
_SECTION = re.compile(r"^={80,}[ \t]*\r?\n", re.MULTILINE)


def split_sections(name: str, text: str, source: str) -> list[tuple[str, str]]:
    """Return name and text of the type itself, then of each contained type.

    Raises:
        FileFormatError: a section without a name, or too much text.
    """
    if len(text) > MAX_CHARACTERS:
        raise FileFormatError(
            source, f"{len(text)} characters; at most {MAX_CHARACTERS} allowed"
        )
    top, *contained = _SECTION.split(text)
    if len(contained) > MAX_SECTIONS:
        raise FileFormatError(
            source, f"{len(contained)} types; at most {MAX_SECTIONS} allowed"
        )
    sections = [(name, top)]
    for section in contained:
        head, _, body = section.partition("\n")
        mark, colon, short = head.partition(": ")
        if not colon or mark not in _MARKS:
            raise FileFormatError(
                source, f"{head[:80]!r}, expected 'MSG: package/Name'"
            )
        sections.append((_section_name(_MARKS[mark], short.strip(), name), body))
    if contained and not top.strip() and contained[0].startswith(("SRV: ", "ACTION: ")):
        del sections[0]  # an event, whose text is that of its service or action
    for section_name, body in sections:
        if body.count("\n") > MAX_LINES:
            raise FileFormatError(
                source,
                f"{section_name[:80]}: more than {MAX_LINES} lines",
            )
    return sections


def _section_name(kind: str, short: str, top: str) -> str:
    """Return the name of a section's type; ``top`` is that of the first type."""
    package, slash, rest = short.partition("/")
    if not slash or "/" in rest:
        return short
    if kind == "msg" and PART_NAME.fullmatch(rest) and top.count("/") == 2:
        kind = top.split("/")[1]  # a part belongs to a service or an action
    return short if kind == "msg" else f"{package}/{kind}/{rest}"


def read_definition(name: str, text: str, source: str = "") -> list[Spec]:
    """Parse a text; return the type called ``name`` first, each type once.

    For a name under ``srv`` or ``action`` the text above the first section contains the
    parts, separated by ``---``; a part (``pkg/srv/Name_Event``) is a message. For the
    text of a service's event in rosbag2's form, the service is first.

    Raises:
        FileFormatError: the text is malformed, defines a type twice, or describes a
            message that is too large or contains itself.
        InvalidNameError: a name has the wrong form.
    """
    source = source or f"definition of {name}"
    found: dict[str, Spec] = {}
    for short, body in split_sections(name, text, source):
        spec = _parse(full_name(short), body, source)
        if found.setdefault(spec.name, spec) != spec:
            raise FileFormatError(source, f"{spec.name} has two different definitions")
    _refuse_too_large(found, source)
    return list(found.values())


def messages_of(spec: Spec) -> Sequence[MessageSpec]:
    """Return the message itself, or the parts of a service or action."""
    return [spec] if isinstance(spec, MessageSpec) else list(spec.parts())


def _parse(name: str, text: str, source: str) -> Spec:
    package, kind, rest = name.split("/")
    is_part = kind != "msg" and PART_NAME.fullmatch(rest) is not None
    if not PACKAGE_NAME.fullmatch(package) or not (
        is_part or INTERFACE_NAME.fullmatch(rest)
    ):
        raise FileFormatError(
            source,
            f"{name[:80]!r} is not a type name (package/{kind}/CamelCase)",
        )
    parse = parse_message if is_part else PARSERS[kind]
    try:
        return parse(name, text, source)
    except FileFormatError:
        raise
    except ValueError as error:  # such as an integer of thousands of digits
        raise FileFormatError(source, f"{name}: {error}") from error


def _refuse_too_large(specs: dict[str, Spec], source: str) -> None:
    messages = {
        part.name: part for spec in specs.values() for part in messages_of(spec)
    }
    sizes: dict[str, tuple[int, int]] = {}
    for spec in specs.values():
        for part in messages_of(spec):
            fields, octets = _size(part, messages, sizes, (), source)
            if fields > MAX_FIELDS or octets > MAX_BYTES:
                raise FileFormatError(
                    source,
                    f"{part.name} would hold {fields} fields and {octets} bytes of "
                    f"arrays; at most {MAX_FIELDS} and {MAX_BYTES} allowed",
                )


def _size(
    spec: MessageSpec,
    messages: dict[str, MessageSpec],
    sizes: dict[str, tuple[int, int]],
    above: tuple[str, ...],
    source: str,
) -> tuple[int, int]:
    """Number of fields, and bytes of fixed-size arrays, nested messages included."""
    if spec.name in above or len(above) >= MAX_DEPTH:
        raise FileFormatError(
            source,
            f"{spec.name} contains itself, or is more than {MAX_DEPTH} types deep",
        )
    if spec.name in sizes:
        return sizes[spec.name]
    fields = octets = 0
    for field in spec.fields:
        size = (field.type.size or 1) if field.type.container == "array" else 1
        if field.type.is_message:
            inner = messages.get(field.type.base) or _known(field.type.base)
            if inner is not None:
                below = _size(inner, messages, sizes, (*above, spec.name), source)
                fields += size * below[0]
                octets += size * below[1]
        elif field.type.is_numeric:
            octets += 8 * size
        else:
            fields += size
        fields += 1
    sizes[spec.name] = fields, octets
    return fields, octets


def _known(name: str) -> MessageSpec | None:
    """A registered type; unknown ones are reported later, by the registration."""
    try:
        return get_message_spec(name)
    except UnknownNameError:
        return None
