"""The last message of topics that are published rarely, for clients that join later.

A path or a marker is published once and holds until the next one; a client that opens
the page in between would not see it. Latched topics need no cache here: their
publishers keep the last message.
"""

from collections import deque
from dataclasses import dataclass, field

from navette.viewer.large_grid import Payload

#: Small types whose messages are a state: each replaces the one before. The view
#: subscribes to their topics while they have a publisher. Goals and poses
#: (PointStamped, PoseStamped) are excluded: they are commands, and a publisher that
#: waits for a subscriber must not find the live view.
STATE_TYPES = frozenset(
    {
        "geometry_msgs/msg/PolygonStamped",
        "geometry_msgs/msg/PoseArray",
        "nav_msgs/msg/OccupancyGrid",
        "nav_msgs/msg/Path",
        "visualization_msgs/msg/Marker",
        "visualization_msgs/msg/MarkerArray",
    }
)

_MAX_BYTES = 4_000_000  # of a message
# This many messages in this time are a stream: the next message comes soon enough.
_STREAM_MESSAGES = 20
_STREAM_NS = 5_000_000_000


@dataclass
class _Topic:
    last: tuple[int, Payload] | None = None
    stamps: deque[int] = field(default_factory=lambda: deque(maxlen=_STREAM_MESSAGES))


class LastValueCache:
    """The newest message and its stamp (ns), by channel id."""

    def __init__(self) -> None:
        self._topics: dict[int, _Topic] = {}
        self._streams: set[int] = set()

    def open(self, channel: int) -> bool:
        """Start to cache a channel; False if it is cached already, or is a stream."""
        if channel in self._topics or channel in self._streams:
            return False
        self._topics[channel] = _Topic()
        return True

    def close(self, channel: int) -> None:
        """Drop a channel that has no publisher any more."""
        self._topics.pop(channel, None)
        self._streams.discard(channel)

    def __contains__(self, channel: int) -> bool:
        return channel in self._topics

    def store(self, channel: int, stamp_ns: int, payload: Payload) -> None:
        """Store a message; a channel with frequent or large messages is dropped."""
        topic = self._topics.get(channel)
        if topic is None:
            return
        topic.last = stamp_ns, payload
        if topic.stamps and stamp_ns < topic.stamps[-1]:
            topic.stamps.clear()  # the clock was set back
        topic.stamps.append(stamp_ns)
        is_stream = (
            len(topic.stamps) == _STREAM_MESSAGES
            and stamp_ns - topic.stamps[0] < _STREAM_NS
        )
        if is_stream or len(payload) > _MAX_BYTES:
            del self._topics[channel]
            self._streams.add(channel)

    def last(self, channel: int) -> tuple[int, Payload] | None:
        topic = self._topics.get(channel)
        return None if topic is None else topic.last

    def clear(self) -> None:
        """Drop all messages, for example after a seek in a recording."""
        for topic in self._topics.values():
            topic.last = None
