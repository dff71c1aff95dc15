"""Reads definitions that travel with data: a text and, below it, what it contains.

The form is that of MCAP's ``ros2msg`` schemas: the type's own text, then for each type
that it refers to a line of ``=``, ``MSG: package/Name`` and that type's text. Such text
comes from files and from the network, so everything about it is bounded.
"""

import re
from collections.abc import Callable, Sequence

from navette.errors import FileFormatError, UnknownNameError
from navette.msgs.interface import MessageSpec, Spec
from navette.msgs.parser import (
    INTERFACE_NAME,
    PACKAGE_NAME,
    parse_action,
    parse_message,
    parse_service,
)
from navette.msgs.registry import full_name, get_message_spec

MOST_CHARACTERS = 1 << 20
MOST_SECTIONS = 500
MOST_LINES = 4096  # of one section
MOST_FIELDS = 1 << 16  # of the type with everything it contains, arrays filled
MOST_BYTES = 1 << 26  # of the fixed arrays of numbers in it
MOST_DEPTH = 32

SECTION = re.compile(r"^={80,}[ \t]*\r?\n", re.MULTILINE)
_PARSERS: dict[str, Callable[[str, str, str], Spec]] = {
    "msg": parse_message,
    "srv": parse_service,
    "action": parse_action,
}
# Parts of services and actions that are messages of their own, as in recordings.
_PART = re.compile(r"[A-Z][A-Za-z0-9]*(?:_[A-Z][A-Za-z0-9]*)+")


def split_sections(
    name: str, text: str, source: str, *, mark: str = "MSG: "
) -> list[tuple[str, str]]:
    """Name and text of the type itself, then of each that it contains.

    Raises:
        FileFormatError: a section without a name, or more text than a definition has.
    """
    if len(text) > MOST_CHARACTERS:
        raise FileFormatError(
            source, f"{len(text)} characters; at most {MOST_CHARACTERS} are read"
        )
    top, *contained = SECTION.split(text)
    if len(contained) > MOST_SECTIONS:
        raise FileFormatError(
            source, f"{len(contained)} types; at most {MOST_SECTIONS} are read"
        )
    sections = [(name, top)]
    for section in contained:
        head, _, body = section.partition("\n")
        if not head.startswith(mark):
            raise FileFormatError(source, f"{head[:80]!r}, wanted '{mark}package/Name'")
        sections.append((head.removeprefix(mark).strip(), body))
    for section_name, body in sections:
        if body.count("\n") > MOST_LINES:
            raise FileFormatError(
                source,
                f"{section_name[:80]}: over {MOST_LINES} lines; no more are read",
            )
    return sections


def read_definition(name: str, text: str, source: str = "") -> list[Spec]:
    """What the text defines: the type called ``name`` first, each type once.

    A name under ``srv`` or ``action`` takes the parts, separated by ``---``, above the
    first section; a part (``pkg/srv/Name_Event``) is a message.

    Raises:
        FileFormatError: the text is broken, contradicts itself, or describes
            something larger than a message can be.
        InvalidNameError: a name has the wrong form.
    """
    source = source or f"definition of {name}"
    found: dict[str, Spec] = {}
    for short, body in split_sections(name, text, source):
        spec = _parse(full_name(short), body, source)
        if found.setdefault(spec.name, spec) != spec:
            raise FileFormatError(source, f"{spec.name} is defined twice, differently")
    _refuse_too_large(found, source)
    return list(found.values())


def messages_of(spec: Spec) -> Sequence[MessageSpec]:
    """The messages that a definition consists of: itself, or a service's parts."""
    return [spec] if isinstance(spec, MessageSpec) else list(spec.parts())


def _parse(name: str, text: str, source: str) -> Spec:
    package, kind, rest = name.split("/")
    is_part = kind != "msg" and _PART.fullmatch(rest) is not None
    if not PACKAGE_NAME.fullmatch(package) or not (
        is_part or INTERFACE_NAME.fullmatch(rest)
    ):
        raise FileFormatError(
            source, f"{name[:80]!r} is no type name: wanted package/{kind}/CamelCase"
        )
    parse = parse_message if is_part else _PARSERS[kind]
    try:
        return parse(name, text, source)
    except FileFormatError:
        raise
    except ValueError as error:  # such as a number of thousands of digits
        raise FileFormatError(source, f"{name}: {error}") from error


def _refuse_too_large(specs: dict[str, Spec], source: str) -> None:
    messages = {
        part.name: part for spec in specs.values() for part in messages_of(spec)
    }
    sizes: dict[str, tuple[int, int]] = {}
    for spec in specs.values():
        for part in messages_of(spec):
            fields, octets = _size(part, messages, sizes, (), source)
            if fields > MOST_FIELDS or octets > MOST_BYTES:
                raise FileFormatError(
                    source,
                    f"{part.name} would hold {fields} fields and {octets} bytes of "
                    f"arrays; at most {MOST_FIELDS} and {MOST_BYTES} are read",
                )


def _size(
    spec: MessageSpec,
    messages: dict[str, MessageSpec],
    sizes: dict[str, tuple[int, int]],
    above: tuple[str, ...],
    source: str,
) -> tuple[int, int]:
    """Fields and bytes of fixed arrays of one message, all that it holds included."""
    if spec.name in above or len(above) >= MOST_DEPTH:
        raise FileFormatError(
            source, f"{spec.name} contains itself, or is over {MOST_DEPTH} types deep"
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
    """Types that the text does not hold; whether somebody has them is asked later."""
    try:
        return get_message_spec(name)
    except UnknownNameError:
        return None
