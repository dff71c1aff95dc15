"""CDR, the wire format of ROS 2 messages."""

from navette.msgs.cdr.codec import deserialize, serialize

__all__ = ["serialize", "deserialize"]
