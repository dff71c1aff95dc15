"""The last message of topics that speak rarely: for clients who come in between.

A path, a marker or a goal is said once and holds until the next one; who opens the
page in the middle of a drive would not see it. Latched topics need nothing of this:
there the publisher itself keeps the last message.
"""

from collections import deque
from dataclasses import dataclass, field

#: Small, and a state: each message replaces the one before. Their topics are listened
#: to at all times, so their publishers serialise for this.
STATE_TYPES = frozenset(
    {
        "geometry_msgs/msg/PointStamped",
        "geometry_msgs/msg/PolygonStamped",
        "geometry_msgs/msg/PoseArray",
        "geometry_msgs/msg/PoseStamped",
        "geometry_msgs/msg/PoseWithCovarianceStamped",
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

    def open(self, channel: int) -> None:
        """Keep what comes from now on."""
        self._topics[channel] = _Topic()

    def close(self, channel: int) -> None:
        """Keep nothing any more."""
        self._topics.pop(channel, None)

    def __contains__(self, channel: int) -> bool:
        return channel in self._topics

    def take(self, channel: int, stamp_ns: int, payload: bytes) -> None:
        """A message; a topic that proves a stream, or large, is closed."""
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
            self.close(channel)

    def last(self, channel: int) -> tuple[int, bytes] | None:
        """Stamp (ns) and message, if there is one."""
        topic = self._topics.get(channel)
        return None if topic is None else topic.last

    def forget(self, channel: int | None = None) -> None:
        """What was said no longer holds: of a channel, or of all."""
        for each, topic in self._topics.items():
            if channel in (None, each):
                topic.last = None
