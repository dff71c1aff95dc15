"""Samples that arrive as bytes: decoded where they are taken, or not at all."""

from collections.abc import Callable
from typing import Any

from navette.errors import DecodeError
from navette.msgs import deserialize


class Encoded:
    """In place of the message of a delivered sample: its CDR bytes.

    Args:
        failed: told why the bytes are no such message.
    """

    __slots__ = ("_failed", "_message_class", "data")

    def __init__(
        self, data: bytes, message_class: type, failed: Callable[[DecodeError], None]
    ) -> None:
        self.data = data
        self._message_class: Any = message_class
        self._failed = failed

    def decode(self) -> Any:
        """The message; None if the bytes are none (which is then reported)."""
        try:
            return deserialize(self.data, self._message_class)
        except DecodeError as error:
            self._failed(error)
            return None
