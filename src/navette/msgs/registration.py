"""Registration of types that are known only from a definition text."""

import hashlib
from collections.abc import Sequence
from dataclasses import replace

from navette.errors import FileFormatError, UnknownNameError
from navette.msgs.definition_sections import messages_of, read_definition
from navette.msgs.interface import FieldType, MessageSpec, Spec
from navette.msgs.registry import add_specs, full_name, get_message_spec

Fields = list[tuple[str, FieldType]]


def load_definition_text(name: str, text: str) -> None:
    """Register an interface from ``ros2msg`` text of a bag or another program.

    ``text`` has the form of ``definition_text``. A registered type with the same fields
    is kept: the text carries no constants and defaults, and those differ between
    releases of ROS 2.

    Raises:
        FileFormatError: the text is malformed or too large, refers to an unknown type,
            or gives a registered type other fields.
    """
    source = f"definition of {name}"
    specs = read_definition(name, text, source)
    for spec in specs:
        if differs(spec):
            raise FileFormatError(
                source, f"{spec.name} is registered with other fields"
            )
    _add(specs, source)


def load_private_definition(name: str, text: str) -> str:
    """Register a definition; a type with other fields than known gets its own name.

    For recordings, which may contain types of another release. A type that differs from
    the registered type of its name, or contains such a type, is registered in a package
    ``<package>__<8 hex digits>``. No real package can have this name, and it depends
    only on the text.

    Returns:
        The full name of the registered type.

    Raises:
        FileFormatError: the text is malformed or too large, or refers to an unknown
            type.
    """
    source = f"definition of {name}"
    specs = read_definition(name, text, source)
    # Of a service that differs, only the recorded messages get another name.
    specs = [
        part
        for spec in specs
        for part in (
            [spec] if spec.name == full_name(name) else _parts_if_different(spec)
        )
    ]
    differing = {spec.name for spec in specs if differs(spec)}
    # A type that contains a private type differs from the public type, too.
    while True:
        more = {
            spec.name
            for spec in specs
            for part in messages_of(spec)
            for field in part.fields
            if field.type.base in differing
        } - differing
        if not more:
            break
        differing |= more
    mark = hashlib.sha256(text.encode()).hexdigest()[:8]
    private = {each: _private_name(each, mark) for each in differing}
    _add([_renamed(spec, private, source) for spec in specs], source)
    return private.get(full_name(name), full_name(name))


def _parts_if_different(spec: Spec) -> Sequence[Spec]:
    return messages_of(spec) if differs(spec) else [spec]


def differs(spec: Spec) -> bool:
    """Whether a type of this name is registered with other fields."""
    for part in messages_of(spec):
        known = _known_fields(part.name)
        if known is not None and known != _fields(part):
            return True
    return False


def _add(specs: Sequence[Spec], source: str) -> None:
    new = [
        spec
        for spec in specs
        if any(_known_fields(part.name) is None for part in messages_of(spec))
    ]
    add_specs(new, [source] * len(new))


def _known_fields(name: str) -> Fields | None:
    try:
        return _fields(get_message_spec(name))
    except UnknownNameError:
        return None


def _fields(spec: MessageSpec) -> Fields:
    return [(field.name, field.type) for field in spec.fields]


def _private_name(name: str, mark: str) -> str:
    package, _, rest = name.partition("/")
    return f"{package}__{mark}/{rest}"


def _renamed(spec: Spec, names: dict[str, str], source: str) -> Spec:
    if not names:
        return spec
    if not isinstance(spec, MessageSpec):
        if spec.name in names:
            raise FileFormatError(
                source, f"{spec.name} is registered with other fields"
            )
        return spec
    fields = tuple(
        replace(
            field,
            type=replace(field.type, base=names.get(field.type.base, field.type.base)),
        )
        for field in spec.fields
    )
    return replace(spec, name=names.get(spec.name, spec.name), fields=fields)
