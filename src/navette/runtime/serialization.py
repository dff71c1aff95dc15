"""Serialization of messages to CDR and back, under rclpy's names."""

from typing import Any, TypeVar

from navette.msgs import deserialize, serialize
from navette.runtime.type_support import check_is_valid_msg_type

MsgT = TypeVar("MsgT")


def serialize_message(message: Any) -> bytes:
    """Return the message as CDR with its 4-byte header."""
    check_is_valid_msg_type(type(message))
    return serialize(message)


def deserialize_message(serialized_message: bytes, message_type: type[MsgT]) -> MsgT:
    """Return the message of that type from CDR.

    Raises:
        DecodeError: the bytes are not such a message.
    """
    check_is_valid_msg_type(message_type)
    found: MsgT = deserialize(serialized_message, message_type)  # type: ignore[type-var] # checked above
    return found
