"""Types that only come with their definition text: from a bag or from a peer."""

import re

from navette.errors import FileFormatError, UnknownNameError
from navette.msgs.interface import MessageSpec
from navette.msgs.parser import parse_message
from navette.msgs.registry import add_specs, full_name, get_spec


def load_definition_text(name: str, text: str) -> None:
    """Make a message known from the ``ros2msg`` text that was sent along with it.

    ``text`` is of the form that ``definition_text`` gives. Types that are known already
    stay; another definition of a known name is refused.

    Raises:
        FileFormatError: the text is broken, refers to types that it does not hold and
            nobody else defines, or contradicts a known type.
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
        known = get_spec(spec.name)
    except UnknownNameError:
        return False
    if known != spec:
        raise FileFormatError(source, f"{spec.name} is known with another definition")
    return True
