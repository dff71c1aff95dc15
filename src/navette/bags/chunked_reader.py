"""Base class of the readers of chunked files."""

from abc import abstractmethod
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from navette.bags.bag import (
    BagMessage,
    BagReader,
    BagTopic,
    Convert,
    Damage,
    MessageQuery,
    OnDamage,
    RecordedMessage,
)
from navette.bags.binary_file import BinaryFile
from navette.bags.chunks import LAST_NS, Chunk, ChunkMerge, ChunkQuery, Entry, FileIndex
from navette.bags.compression import is_zstd, unpack_zstd_message
from navette.errors import DecodeError, FileFormatError


class ChunkedReader(BagReader):
    """Reads messages through the index of a chunked file.

    A derived class reads the index, and the bytes and messages of chunks.

    Args:
        file: closed with the reader.
    """

    def __init__(self, file: BinaryFile) -> None:
        self.path = file.path
        self.size = file.size
        self._file = file
        self._topic_of: dict[int, BagTopic] = {}
        self._convert_of: dict[int, Convert] = {}
        self._shared: dict[BagTopic, BagTopic] = {}
        try:
            self.index = self._read_index()
        except BaseException:
            self.close()
            raise
        self.topics = tuple(self._shared)
        self.problems = tuple(self.index.problems)
        self.remarks = tuple(self.index.remarks)
        # Chunks without messages have no times.
        filled = [c for c in self.chunks if c.channels or c.start_ns or c.end_ns]
        self.start_ns = min((chunk.start_ns for chunk in filled), default=0)
        self.end_ns = max((chunk.end_ns for chunk in filled), default=0)
        self._known_counts = self._counts_by_topic()

    # -- implemented by each format ----------------------------------------------

    @abstractmethod
    def _read_index(self) -> FileIndex:
        """Read the index, and register the channels with :meth:`_add_channel`."""

    @abstractmethod
    def scanned(self) -> FileIndex:
        """Return the index from a scan of the records."""

    @abstractmethod
    def index_of(self, chunk: Chunk) -> Mapping[int, Sequence[int]] | None:
        """Return stamps by channel from the index; None without an index.

        Raises:
            FileFormatError: the index is damaged.
        """

    @abstractmethod
    def read_chunk(self, chunk: Chunk) -> bytes: ...

    @abstractmethod
    def parse_chunk(self, chunk: Chunk, data: bytes) -> list[Entry]: ...

    def _add_channel(
        self, number: int, topic: BagTopic, convert: Convert | None = None
    ) -> None:
        """Register a channel; channels that are described equally share a topic.

        Args:
            convert: applied to every message, also ``as_recorded``.
        """
        self._topic_of[number] = self._shared.setdefault(topic, topic)
        if convert is not None:
            self._convert_of[number] = convert

    # -- common to all formats ---------------------------------------------------

    @property
    def losses(self) -> tuple[str, ...]:
        return self.index.losses

    @property
    def chunks(self) -> Sequence[Chunk]:
        return self.index.chunks

    def close(self) -> None:
        self._file.close()

    def topic_of(self, channel: int) -> BagTopic | None:
        """Return the topic of a channel; None for an undefined channel."""
        return self._topic_of.get(channel)

    def entries(self, chunk: Chunk) -> list[Entry]:
        """Return the messages of a chunk in file order.

        Raises:
            FileFormatError: the chunk is damaged.
        """
        return self.parse_chunk(chunk, self.read_chunk(chunk))

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

    @property
    def compression(self) -> Mapping[str, int]:
        return Counter(chunk.compression or "none" for chunk in self.chunks)

    def counts(self) -> Mapping[BagTopic, int]:
        if self._known_counts is None:
            self._known_counts = Counter(topic for topic, _ in self.stamps())
        return {topic: self._known_counts[topic] for topic in self.topics}

    def _counts_by_topic(self) -> Counter[BagTopic] | None:
        if self.index.counts is None:
            return None
        counts: Counter[BagTopic] = Counter()
        for channel, count in self.index.counts.items():
            if channel in self._topic_of:
                counts[self._topic_of[channel]] += count
        return counts

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

    def read(self, query: MessageQuery) -> Iterator[BagMessage]:
        found = self._read(query, self._topic_of, self._all_to_cdr())
        for topic, entry, data in found:
            yield BagMessage(topic, entry[0], data)

    def read_recorded(
        self, query: MessageQuery, *, as_cdr: bool
    ) -> Iterator[RecordedMessage]:
        topic_of, convert_of = self._topic_of, self._all_to_cdr()
        if not as_cdr:
            topic_of = {n: topic.as_recorded for n, topic in topic_of.items()}
            convert_of = self._convert_of
        found = self._read(query, topic_of, convert_of)
        for topic, entry, data in found:
            yield RecordedMessage(
                topic, entry.stamp_ns, data, entry.publish_ns, entry.sequence
            )

    def _all_to_cdr(self) -> dict[int, Convert]:
        """Return all conversions by channel, including the optional ones."""
        convert_of = dict(self._convert_of)
        for number, topic in self._topic_of.items():
            if topic.channel is not None and topic.channel.to_cdr is not None:
                convert_of[number] = topic.channel.to_cdr
        return convert_of

    def _chunk_query(self, query: MessageQuery) -> ChunkQuery:
        names = query.names
        channels = frozenset(
            number
            for number, topic in self._topic_of.items()
            if names is None or topic.name in names
        )
        return ChunkQuery(
            channels if names is not None else None,
            0 if query.start_ns is None else query.start_ns,
            LAST_NS if query.end_ns is None else query.end_ns,
        )

    def _read(
        self,
        query: MessageQuery,
        topic_of: Mapping[int, BagTopic],
        convert_of: Mapping[int, Convert],
    ) -> Iterator[tuple[BagTopic, Entry, bytes]]:
        on_damage = query.on_damage
        merge = ChunkMerge(self, on_damage=on_damage)
        for entry, data in merge.messages(self.chunks, self._chunk_query(query)):
            channel = entry[1]
            topic = topic_of.get(channel)
            if topic is None:
                reason = f"a message of undefined channel {channel}"
                self._damaged(entry, reason, on_damage)
                continue
            try:
                if channel in convert_of:
                    data = convert_of[channel](data)
                elif is_zstd(data) and topic.encoding == "cdr":
                    data = unpack_zstd_message(data)  # compression_mode "message"
            except DecodeError as error:
                self._damaged(entry, str(error), on_damage)
                continue
            yield topic, entry, data

    def _damaged(self, entry: Entry, reason: str, on_damage: OnDamage | None) -> None:
        reason = f"message at {entry.stamp_ns} ns: {reason}"
        if on_damage is None:
            raise FileFormatError(self.path, reason)
        on_damage(Damage(self.path, entry.begin, reason))
