"""Messages as bytes."""

from navette.runtime.serialization import deserialize_message, serialize_message
from navette.runtime.type_support import MsgT, check_for_type_support

__all__ = [
    "MsgT",
    "check_for_type_support",
    "deserialize_message",
    "serialize_message",
]
