"""Messages that arrive as bytes and are decoded when they are taken, if at all."""

from collections.abc import Callable
from typing import Any

from navette.errors import DecodeError
from navette.msgs import deserialize

OnDecodeError = Callable[[DecodeError], None]
"""Called if the bytes of a sample cannot be decoded."""


class Encoded:
    """CDR bytes in place of the message of a delivered sample."""

    __slots__ = ("_message_class", "_on_error", "data")

    def __init__(
        self, data: bytes, message_class: type, on_error: OnDecodeError
    ) -> None:
        self.data = data
        self._message_class: Any = message_class
        self._on_error = on_error

    def decode(self) -> Any:
        """Return the message; None if the bytes are invalid, which is reported."""
        try:
            return deserialize(self.data, self._message_class)
        except DecodeError as error:
            self._on_error(error)
            return None
