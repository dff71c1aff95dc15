"""What clients publish: bytes to messages."""

import json
from typing import Any

from navette.errors import DecodeError
from navette.msgs import Message, deserialize, from_dict


def decode_message(encoding: str, cls: type[Message], data: bytes) -> Message:
    """A client's message, ``cdr`` or ``json``.

    JSON fields that are left out keep their defaults; stamps may spell nanoseconds
    ``nsec``, as Foxglove does, or ``nanosec``.

    Raises:
        DecodeError: the bytes are no such message.
        MessageError: a field is unknown or of the wrong type; it is named.
    """
    if encoding == "cdr":
        return deserialize(data, cls)
    try:
        document = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise DecodeError(f"message is not JSON: {error}") from None
    if not isinstance(document, dict):
        raise DecodeError("message is not a JSON object")
    return from_dict(cls, _with_ros_names(document))


def _with_ros_names(value: Any) -> Any:
    """Stamps written {sec, nsec} become {sec, nanosec}, at any depth."""
    if isinstance(value, list):
        return [_with_ros_names(item) for item in value]
    if not isinstance(value, dict):
        return value
    if value.keys() == {"sec", "nsec"}:
        return {"sec": value["sec"], "nanosec": value["nsec"]}
    return {name: _with_ros_names(item) for name, item in value.items()}
