"""Samples that expire: the lifespan of a publisher's QoS."""

from typing import Any


class Expiring:
    """In place of the message of a delivered sample: the message, and until when.

    ``message`` may be an :class:`~navette.transports.encoded.Encoded`.
    """

    __slots__ = ("expires_ns", "message")

    def __init__(self, message: Any, expires_ns: int) -> None:
        self.message = message
        self.expires_ns = expires_ns

    def at(self, now_ns: int) -> Any:
        """The message; None if it is too old by then."""
        return self.message if now_ns < self.expires_ns else None
