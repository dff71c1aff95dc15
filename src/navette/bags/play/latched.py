"""The last messages before a position of a recording."""

from collections import defaultdict, deque

from navette.bags.bag import BagMessage, BagTopic
from navette.bags.play.source import Source
from navette.msgs import deserialize
from navette.msgs.tf2_msgs.msg import TFMessage

_FIRST_WINDOW_NS = 10_000_000_000
_WIDER = 8
_MOST = 1000
_RECENT_NS = 2_000_000_000
_TRANSFORMS = "tf2_msgs/msg/TFMessage"


def is_latched(topic: BagTopic) -> bool:
    """Whether the topic was recorded as latched; static transforms always are."""
    return topic.latched or topic.name.endswith("/tf_static")


def latched_depth(topic: BagTopic) -> int:
    """Number of last messages of a topic to use.

    Each publisher keeps its own messages; static transforms come from many publishers,
    which the file does not distinguish, so all of them are used.
    """
    if topic.type_name == _TRANSFORMS:
        return _MOST
    offers = [q for q in topic.qos if q.durability == "transient_local"]
    if any(q.history == "keep_all" for q in offers):
        return _MOST
    return min(_MOST, max(1, sum(max(1, q.depth) for q in offers)))


def latched_before(
    source: Source, topics: tuple[BagTopic, ...], stamp_ns: int
) -> list[BagMessage]:
    """Return the last messages of latched topics before a stamp, by stamp.

    Searches backwards in growing windows: a map published at 1 Hz is found without
    reading an hour of maps.
    """
    missing = {t: latched_depth(t) for t in topics if is_latched(t)}
    found: dict[BagTopic, deque[BagMessage]] = defaultdict(deque)
    end_ns, window_ns = stamp_ns - 1, _FIRST_WINDOW_NS
    while missing and end_ns >= source.start_ns:
        start_ns = max(source.start_ns, end_ns - window_ns + 1)
        for topic, older in _by_topic(source, set(missing), start_ns, end_ns).items():
            wanted = missing[topic]
            found[topic].extendleft(list(reversed(older))[:wanted])
            missing[topic] -= min(wanted, len(older))
        missing = {t: n for t, n in missing.items() if n > 0}
        end_ns, window_ns = start_ns - 1, window_ns * _WIDER
    every = [message for messages in found.values() for message in messages]
    return sorted(every, key=lambda message: message.stamp_ns)


def recent_before(
    source: Source, topics: tuple[BagTopic, ...], stamp_ns: int
) -> list[BagMessage]:
    """Return the last message of each topic that is not latched, by stamp.

    Only of the last two seconds: older values say little about that moment. Of
    transforms, each message has some of the frames: the last of each such set.
    """
    others = {topic for topic in topics if not is_latched(topic)}
    found = _by_topic(source, others, stamp_ns - _RECENT_NS, stamp_ns - 1)
    last = {
        (topic, _child_frames(message)): message
        for topic, messages in found.items()
        for message in messages
    }
    return sorted(last.values(), key=lambda message: message.stamp_ns)


def _child_frames(message: BagMessage) -> frozenset[str]:
    """Return the frames that a message of transforms places; empty for others."""
    if message.topic.type_name != _TRANSFORMS:
        return frozenset()
    transforms = deserialize(message.data, TFMessage).transforms
    return frozenset(transform.child_frame_id for transform in transforms)


def _by_topic(
    source: Source, topics: set[BagTopic], start_ns: int, end_ns: int
) -> dict[BagTopic, deque[BagMessage]]:
    names = {topic.name for topic in topics}
    found: dict[BagTopic, deque[BagMessage]] = {
        t: deque(maxlen=latched_depth(t)) for t in topics
    }
    for message in source.messages(names, start_ns=start_ns, end_ns=end_ns):
        if message.topic in found:
            found[message.topic].append(message)
    return found
