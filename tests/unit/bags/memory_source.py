"""A recording in memory, for playback."""

from collections.abc import Collection, Iterator

from navette.bags import OfferedQos
from navette.bags.bag import BagMessage, BagTopic
from navette.msgs import definition_text, serialize, type_name

S = 1_000_000_000
LATCHED = OfferedQos(depth=1, durability="transient_local")


class MemorySource:
    """Messages of topics, sorted by stamp; counts the reads."""

    def __init__(self, messages: Collection[BagMessage]) -> None:
        self._messages = sorted(messages, key=lambda m: m.stamp_ns)
        self.topics = tuple(dict.fromkeys(m.topic for m in self._messages))
        self.start_ns = self._messages[0].stamp_ns if messages else 0
        self.end_ns = self._messages[-1].stamp_ns if messages else 0
        self.read = 0

    def messages(
        self,
        topics: Collection[str] | None = None,
        *,
        start_ns: int | None = None,
        end_ns: int | None = None,
    ) -> Iterator[BagMessage]:
        for message in self._messages:
            if topics is not None and message.topic.name not in topics:
                continue
            if start_ns is not None and message.stamp_ns < start_ns:
                continue
            if end_ns is not None and message.stamp_ns > end_ns:
                return
            self.read += 1
            yield message


def topic_of(
    name: str, message_type: type, *qos: OfferedQos, definition: bool = True
) -> BagTopic:
    kind = type_name(message_type)
    text = definition_text(kind) if definition else ""
    return BagTopic(name, kind, text, qos=qos)


def recorded(topic: BagTopic, stamp_s: float, message: object) -> BagMessage:
    return BagMessage(topic, round(stamp_s * S), serialize(message))
