"""Base class of the readers of chunked files."""

from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Self

from navette.bags.bag import BagMessage, BagTopic, Damage, OnDamage
from navette.bags.chunks import Chunk, ChunkMerge, ChunkQuery, Entry
from navette.bags.compression import is_zstd, unpack_zstd_message
from navette.errors import DecodeError, FileFormatError

Convert = Callable[[bytes], bytes]
FOREVER_NS = 2**63 - 1


class ChunkedReader(ABC):
    """A :class:`~navette.bags.bag.BagReader` over the index of a chunked file.

    A derived class sets ``path``, ``topics``, ``chunks``, ``problems`` and the channels
    (:meth:`_add_channel`) in its constructor, and reads bytes and messages of chunks.
    """

    storage = ""
    version = ""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.topics: tuple[BagTopic, ...] = ()
        self.problems: tuple[str, ...] = ()
        self.chunks: Sequence[Chunk] = ()
        self.size = 0
        self._topic_of: dict[int, BagTopic] = {}
        self._convert_of: dict[int, Convert] = {}
        self._known_counts: dict[BagTopic, int] | None = None

    # -- implemented by each format ----------------------------------------------

    @abstractmethod
    def _read_chunk(self, chunk: Chunk) -> bytes: ...

    @abstractmethod
    def _entries(self, chunk: Chunk, data: bytes) -> list[Entry]: ...

    @abstractmethod
    def close(self) -> None:
        """Close the file; a second call has no effect."""

    def _add_channel(
        self, number: int, topic: BagTopic, convert: Convert | None = None
    ) -> None:
        """Register a channel; channels with the same topic and type share a topic."""
        same = next((t for t in self.topics if t == topic), None)
        if same is None:
            self.topics = (*self.topics, topic)
        self._topic_of[number] = same or topic
        if convert is not None:
            self._convert_of[number] = convert

    # -- common to all formats ---------------------------------------------------

    def topic_of(self, channel: int) -> BagTopic | None:
        """Return the topic of a channel; None for an undefined channel."""
        return self._topic_of.get(channel)

    def entries(self, chunk: Chunk) -> list[Entry]:
        """Return the messages of a chunk in file order.

        Raises:
            FileFormatError: the chunk is damaged.
        """
        return self._entries(chunk, self._read_chunk(chunk))

    @abstractmethod
    def index_of(self, chunk: Chunk) -> Mapping[int, Sequence[int]] | None:
        """Return stamps by channel from the index; None without an index.

        Raises:
            FileFormatError: the index is damaged.
        """

    @property
    def files(self) -> tuple[Path, ...]:
        return (self.path,)

    @property
    def start_ns(self) -> int:
        return min((chunk.start_ns for chunk in self._filled()), default=0)

    @property
    def end_ns(self) -> int:
        return max((chunk.end_ns for chunk in self._filled()), default=0)

    def _stamps_of(self, chunk: Chunk) -> Mapping[int, Sequence[int]]:
        try:
            indexed = self.index_of(chunk)
        except FileFormatError:
            indexed = None  # the messages themselves may be intact
        if indexed is not None:
            return indexed
        found: dict[int, list[int]] = {}
        for entry in self.entries(chunk):
            found.setdefault(entry.channel, []).append(entry.stamp_ns)
        return found

    def _filled(self) -> Iterator[Chunk]:
        """Chunks with messages; others have no times."""
        return (c for c in self.chunks if c.channels or c.start_ns or c.end_ns)

    @property
    def compression(self) -> Mapping[str, int]:
        return Counter(chunk.compression or "none" for chunk in self.chunks)

    def counts(self) -> Mapping[BagTopic, int]:
        if self._known_counts is None:
            found: Counter[BagTopic] = Counter()
            for topic, _ in self.stamps():
                found[topic] += 1
            self._known_counts = dict(found)
        return {topic: self._known_counts.get(topic, 0) for topic in self.topics}

    def _set_counts(self, by_channel: Mapping[int, int]) -> None:
        counts: Counter[BagTopic] = Counter()
        for channel, count in by_channel.items():
            if channel in self._topic_of:
                counts[self._topic_of[channel]] += count
        self._known_counts = dict(counts)

    def stamps(self) -> Iterator[tuple[BagTopic, int]]:
        for chunk in self.chunks:
            try:
                by_channel = self._stamps_of(chunk)
            except FileFormatError:
                continue  # reported by messages(); only intact chunks count here
            for channel, stamps in by_channel.items():
                topic = self._topic_of.get(channel)
                if topic is not None:
                    for stamp in stamps:
                        yield topic, stamp

    def messages(
        self,
        topics: Collection[str] | None = None,
        *,
        start_ns: int | None = None,
        end_ns: int | None = None,
        on_damage: OnDamage | None = None,
    ) -> Iterator[BagMessage]:
        channels = frozenset(
            number
            for number, topic in self._topic_of.items()
            if topics is None or topic.name in topics
        )
        query = ChunkQuery(
            channels if topics is not None else None,
            -FOREVER_NS if start_ns is None else start_ns,
            FOREVER_NS if end_ns is None else end_ns,
        )
        merge = ChunkMerge(self._read_chunk, self._entries, on_damage)
        for entry, data in merge.messages(self.chunks, query):
            message = self._message(entry, data, on_damage)
            if message is not None:
                yield message

    def _message(
        self, entry: Entry, data: bytes, on_damage: OnDamage | None
    ) -> BagMessage | None:
        topic = self._topic_of.get(entry.channel)
        convert = self._convert_of.get(entry.channel)
        try:
            if topic is None:
                raise DecodeError(f"a message of undefined channel {entry.channel}")
            if convert is not None:
                data = convert(data)
            elif is_zstd(data):  # rosbag2 with compression_mode "message"
                data = unpack_zstd_message(data)
        except DecodeError as error:
            damage = Damage(
                self.path, entry.begin, f"message at {entry.stamp_ns} ns: {error}"
            )
            if on_damage is None:
                raise FileFormatError(self.path, damage.reason) from error
            on_damage(damage)
            return None
        return BagMessage(topic, entry.stamp_ns, data)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
