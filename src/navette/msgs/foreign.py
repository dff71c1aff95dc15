"""Types that only come with their definition text: from a bag or from a peer."""

import hashlib
from collections.abc import Sequence
from dataclasses import replace

from navette.errors import FileFormatError, UnknownNameError
from navette.msgs.definition_sections import messages_of, read_definition
from navette.msgs.interface import FieldType, MessageSpec, Spec
from navette.msgs.registry import add_specs, full_name, get_message_spec

Fields = list[tuple[str, FieldType]]


def load_definition_text(name: str, text: str) -> None:
    """Make an interface known from the ``ros2msg`` text that was sent along with it.

    ``text`` is of the form that ``definition_text`` gives. A type that is known already
    stays as it is, if its fields are the same: constants and defaults do not travel,
    and they differ between releases of ROS 2.

    Raises:
        FileFormatError: the text is broken, out of bounds, refers to types that it does
            not hold and nobody else defines, or gives a known type other fields.
    """
    source = f"definition of {name}"
    specs = read_definition(name, text, source)
    for spec in specs:
        if differs(spec):
            raise FileFormatError(source, f"{spec.name} is known with other fields")
    _add(specs, source)


def load_private_definition(name: str, text: str) -> str:
    """As :func:`load_definition_text`, but a type with other fields gets its own name.

    For recordings, in which a known type may be that of another release. What differs
    from the known type of its name, and what contains such a type, is put into a
    package ``<package>__<8 hex digits>``, which no package can be called and which
    depends on the text alone.

    Returns:
        The full name under which the type is known now.
    """
    source = f"definition of {name}"
    specs = read_definition(name, text, source)
    differing = {spec.name for spec in specs if differs(spec)}
    # What refers to a private type is not the public type of its own name, either.
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


def _add(specs: Sequence[Spec], source: str) -> None:
    new = [spec for spec in specs if not _is_known(spec)]
    add_specs(new, [source] * len(new))


def _is_known(spec: Spec) -> bool:
    return all(_known_fields(part.name) is not None for part in messages_of(spec))


def differs(spec: Spec) -> bool:
    """Whether the name is known with other fields."""
    for part in messages_of(spec):
        known = _known_fields(part.name)
        if known is not None and known != _fields(part):
            return True
    return False


def _known_fields(name: str) -> Fields | None:
    try:
        return _fields(get_message_spec(name))
    except UnknownNameError:
        return None


def _fields(spec: MessageSpec) -> Fields:
    """What is on the wire."""
    return [(field.name, field.type) for field in spec.fields]


def _private_name(name: str, mark: str) -> str:
    package, _, rest = name.partition("/")
    return f"{package}__{mark}/{rest}"


def _renamed(spec: Spec, names: dict[str, str], source: str) -> Spec:
    if not names:
        return spec
    if not isinstance(spec, MessageSpec):
        if spec.name in names:
            raise FileFormatError(source, f"{spec.name} is known with other fields")
        return spec
    fields = tuple(
        replace(
            field,
            type=replace(field.type, base=names.get(field.type.base, field.type.base)),
        )
        for field in spec.fields
    )
    return replace(spec, name=names.get(spec.name, spec.name), fields=fields)
