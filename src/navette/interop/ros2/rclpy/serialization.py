"""Messages as bytes."""

from navette.runtime.serialization import deserialize_message, serialize_message

__all__ = ["deserialize_message", "serialize_message"]
