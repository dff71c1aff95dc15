"""Types that only come with their definition text: from a bag or from a peer."""

import re

from navette.errors import FileFormatError, UnknownNameError
from navette.msgs.interface import FieldType, MessageSpec
from navette.msgs.parser import parse_message
from navette.msgs.registry import add_specs, full_name, get_message_spec


def load_definition_text(name: str, text: str) -> None:
    """Make a message known from the ``ros2msg`` text that was sent along with it.

    ``text`` is of the form that ``definition_text`` gives. A type that is known already
    stays as it is, if its fields are the same: constants and defaults do not travel,
    and they differ between releases of ROS 2.

    Raises:
        FileFormatError: the text is broken, refers to types that it does not hold and
            nobody else defines, or gives a known type other fields.
    """
    source = f"definition of {name}"
    top, *contained = re.split(r"^={80,}\n", text, flags=re.MULTILINE)
    specs = [parse_message(full_name(name), top, source)]
    for section in contained:
        head, _, body = section.partition("\n")
        if not head.startswith("MSG: "):
            raise FileFormatError(source, f"{head!r}, wanted 'MSG: package/Name'")
        specs.append(parse_message(full_name(head[5:].strip()), body, source))
    new = [spec for spec in specs if not _is_known(spec, source)]
    add_specs(new, [source] * len(new))


def _is_known(spec: MessageSpec, source: str) -> bool:
    try:
        known = get_message_spec(spec.name)
    except UnknownNameError:
        return False
    if _on_the_wire(known) != _on_the_wire(spec):
        raise FileFormatError(source, f"{spec.name} is known with other fields")
    return True


def _on_the_wire(spec: MessageSpec) -> list[tuple[str, FieldType]]:
    return [(field.name, field.type) for field in spec.fields]
