"""The last message of topics that speak rarely: for clients who come in between.

A path or a marker is said once and holds until the next one; who opens the page in the
middle of a drive would not see it. Latched topics need nothing of this: there the
publisher itself keeps the last message.
"""

from collections import deque
from dataclasses import dataclass, field

#: Small, and a state: each message replaces the one before. Their topics are listened
#: to as long as somebody publishes them, who serialises for this. No goals and poses
#: (PointStamped, PoseStamped): these are commands, and who gives one waits for a
#: listener, who must not be the live view.
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

_MOST_BYTES = 4_000_000  # of a message
_OFTEN = 20  # messages in so many seconds are a stream: the next one comes soon enough
_OFTEN_NS = 5_000_000_000


@dataclass
class _Topic:
    last: tuple[int, bytes] | None = None
    stamps: deque[int] = field(default_factory=lambda: deque(maxlen=_OFTEN))


class LastMessages:
    """By channel id: the newest message and its stamp (ns)."""

    def __init__(self) -> None:
        self._topics: dict[int, _Topic] = {}
        self._streams: set[int] = set()

    def open(self, channel: int) -> bool:
        """Keep what comes from now on; False where that is so, or it is a stream."""
        if channel in self._topics or channel in self._streams:
            return False
        self._topics[channel] = _Topic()
        return True

    def close(self, channel: int) -> None:
        """Keep nothing any more: nobody publishes it."""
        self._topics.pop(channel, None)
        self._streams.discard(channel)

    def __contains__(self, channel: int) -> bool:
        return channel in self._topics

    def take(self, channel: int, stamp_ns: int, payload: bytes) -> None:
        """A message; a topic that proves a stream, or large, is kept no more."""
        topic = self._topics.get(channel)
        if topic is None:
            return
        topic.last = stamp_ns, payload
        if topic.stamps and stamp_ns < topic.stamps[-1]:
            topic.stamps.clear()  # the clock was set back
        topic.stamps.append(stamp_ns)
        is_stream = (
            len(topic.stamps) == _OFTEN and stamp_ns - topic.stamps[0] < _OFTEN_NS
        )
        if is_stream or len(payload) > _MOST_BYTES:
            del self._topics[channel]
            self._streams.add(channel)

    def last(self, channel: int) -> tuple[int, bytes] | None:
        """Stamp (ns) and message, if there is one."""
        topic = self._topics.get(channel)
        return None if topic is None else topic.last

    def forget(self) -> None:
        """What was said no longer holds."""
        for topic in self._topics.values():
            topic.last = None
