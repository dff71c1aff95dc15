"""The part of :mod:`navette.msgs` that needs numpy.

Loaded on first use, so that programs that only name types start faster.
"""

from navette.msgs.base import Message, fields, validate
from navette.msgs.cdr import deserialize, serialize
from navette.msgs.classes import get_interface, register_definition, type_name
from navette.msgs.convert import from_dict, to_dict
from navette.msgs.copying import copy_message

__all__ = [
    "Message",
    "get_interface",
    "register_definition",
    "type_name",
    "serialize",
    "deserialize",
    "copy_message",
    "to_dict",
    "from_dict",
    "fields",
    "validate",
]
