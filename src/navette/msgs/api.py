"""What :mod:`navette.msgs` offers beyond names and definitions: it needs numpy.

Apart from the package so that listing types (a command line's start) stays cheap.
"""

from navette.msgs.base import Message, fields
from navette.msgs.cdr import deserialize, serialize
from navette.msgs.classes import get_interface, type_name
from navette.msgs.convert import from_dict, to_dict
from navette.msgs.copying import copier_of, copy_message
from navette.msgs.registration import register_definition
from navette.msgs.validation import validate

__all__ = [
    "Message",
    "get_interface",
    "register_definition",
    "type_name",
    "serialize",
    "deserialize",
    "copy_message",
    "copier_of",
    "to_dict",
    "from_dict",
    "fields",
    "validate",
]
