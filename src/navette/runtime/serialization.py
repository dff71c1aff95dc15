"""rclpy's names for CDR: a message to bytes and back."""

from typing import Any, TypeVar

from navette.msgs import deserialize, serialize
from navette.runtime.type_support import check_is_valid_msg_type

MsgT = TypeVar("MsgT")


def serialize_message(message: Any) -> bytes:
    """CDR with its 4-byte header."""
    check_is_valid_msg_type(type(message))
    return serialize(message)


def deserialize_message(serialized_message: bytes, message_type: type[MsgT]) -> MsgT:
    """The message of that type in the bytes.

    Raises:
        DecodeError: they hold none.
    """
    check_is_valid_msg_type(message_type)
    found: MsgT = deserialize(serialized_message, message_type)  # type: ignore[type-var]
    return found
