"""Registers types at run time: from a bag, or from a peer that describes its own."""

from navette.msgs.classes import get_interface
from navette.msgs.foreign import load_definition_text, load_private_definition


def register_definition(type_name: str, text: str, *, private: bool = False) -> type:
    """The class of a type that comes with its definition, which it makes known.

    Args:
        type_name: ``pkg/msg/Name`` (or ``pkg/Name``), ``pkg/srv/Name``,
            ``pkg/action/Name``.
        text: its ``ros2msg`` text, with a section ``MSG: pkg/Name`` below a line of 80
            ``=`` for each type that it contains and nobody knows.
        private: where the name is known with other fields, give a class of another
            name instead of an error: a bag may be older than the type that is
            installed.

    A known type with the same fields (that is: with the same RIHS01 hash) is kept, and
    its class is given.

    Raises:
        FileFormatError: the text is broken, larger than definitions are, refers to a
            type that nobody defines, or the name is known with other fields.
        InvalidNameError: ``type_name`` has the wrong form.
    """
    if private:
        return get_interface(load_private_definition(type_name, text))
    load_definition_text(type_name, text)
    return get_interface(type_name)
