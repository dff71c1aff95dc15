"""Messages that arrive as bytes and are decoded when they are taken, if at all."""

from collections.abc import Callable
from typing import Any

from navette.errors import DecodeError
from navette.msgs import deserialize


class Encoded:
    """CDR bytes in place of the message of a delivered sample.

    Args:
        failed: called with the error if the bytes cannot be decoded.
    """

    __slots__ = ("_failed", "_message_class", "data")

    def __init__(
        self, data: bytes, message_class: type, failed: Callable[[DecodeError], None]
    ) -> None:
        self.data = data
        self._message_class: Any = message_class
        self._failed = failed

    def decode(self) -> Any:
        """Return the message; None if the bytes are invalid, which is reported."""
        try:
            return deserialize(self.data, self._message_class)
        except DecodeError as error:
            self._failed(error)
            return None
