"""Messages as bytes."""

from navette.msgs import deserialize as deserialize_message
from navette.msgs import serialize as serialize_message

__all__ = ["deserialize_message", "serialize_message"]
