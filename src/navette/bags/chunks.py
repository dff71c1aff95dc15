"""Merge the chunks of a file in time order.

Chunks may overlap in time, and messages inside a chunk are in order of reception. A
chunk is opened when its first stamp is reached, and merged with those already open.
The bytes of open chunks are cached up to a limit and read again beyond it: a file whose
chunks all overlap is slow to read, but does not exhaust memory.
"""

from collections import Counter, OrderedDict, deque
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field
from heapq import heappop, heappush
from operator import attrgetter
from typing import NamedTuple, Protocol

from navette.bags.bag import Damage, OnDamage
from navette.errors import FileFormatError

CACHE_BYTES = 128 << 20
LAST_NS = 2**64 - 1
"""Last stamp that a file can contain."""


@dataclass(frozen=True, slots=True)
class Chunk:
    """A part of a file that is read as a whole.

    ``channels`` are those with messages in it, None if unknown. A bare chunk is a
    sequence of records outside any chunk of the file.
    """

    number: int
    position: int
    length: int
    start_ns: int
    end_ns: int
    compression: str = ""
    channels: frozenset[int] | None = None
    bare: bool = False


@dataclass
class FileIndex:
    """All chunks of a file in the order of the file."""

    chunks: list[Chunk] = field(default_factory=list)
    counts: Counter[int] | None = None
    """Messages by channel; None if they are not known without reading the chunks."""
    problems: list[str] = field(default_factory=list)
    losses: tuple[str, ...] = ()
    """The problems by which messages are lost."""
    remarks: list[str] = field(default_factory=list)
    is_scanned: bool = False
    """Whether the records were scanned, because the file's own index is unusable."""


class Entry(NamedTuple):
    """Position of a message in the bytes of its chunk."""

    stamp_ns: int
    channel: int
    begin: int
    end: int
    publish_ns: int | None = None
    sequence: int | None = None


class ChunkQuery(NamedTuple):
    """Selected channels (None: all) and range of stamps."""

    channels: frozenset[int] | None
    first_ns: int
    last_ns: int

    @property
    def takes_all(self) -> bool:
        """Whether no message can be excluded, whatever a chunk's index states."""
        is_unbounded = self.first_ns <= 0 and self.last_ns >= LAST_NS
        return self.channels is None and is_unbounded

    def may_be_in(self, chunk: Chunk) -> bool:
        if chunk.end_ns < self.first_ns or chunk.start_ns > self.last_ns:
            return False
        if self.channels is None or chunk.channels is None:
            return True
        return not self.channels.isdisjoint(chunk.channels)

    def takes(self, entry: Entry) -> bool:
        if not self.first_ns <= entry.stamp_ns <= self.last_ns:
            return False
        return self.channels is None or entry.channel in self.channels


class ChunkFile(Protocol):
    """A file of chunks; its methods raise FileFormatError for damaged ones."""

    def read_chunk(self, chunk: Chunk) -> bytes:
        """Return the uncompressed bytes of a chunk."""

    def parse_chunk(self, chunk: Chunk, data: bytes) -> list[Entry]:
        """Return the messages in these bytes, in the order of the file."""


class _Open(NamedTuple):
    """An open chunk in the heap, ordered by its next message."""

    stamp_ns: int
    number: int
    place: int
    chunk: Chunk
    entries: list[Entry]


class ChunkMerge:
    """Reads chunks in time order.

    Args:
        on_damage: see :meth:`BagReader.messages`.
    """

    def __init__(
        self,
        file: ChunkFile,
        *,
        on_damage: OnDamage | None = None,
        cache_bytes: int = CACHE_BYTES,
    ) -> None:
        self._file = file
        self._on_damage = on_damage
        self._cache_bytes = cache_bytes
        self._cached: OrderedDict[int, bytes] = OrderedDict()
        self._size = 0

    def messages(
        self, chunks: Sequence[Chunk], query: ChunkQuery
    ) -> Iterator[tuple[Entry, bytes]]:
        wanted = [chunk for chunk in chunks if query.may_be_in(chunk)]
        waiting = deque(sorted(wanted, key=lambda c: (c.start_ns, c.number)))
        heap: list[_Open] = []
        while heap or waiting:
            while waiting and (not heap or waiting[0].start_ns <= heap[0].stamp_ns):
                self._open(waiting.popleft(), query, heap)
            if not heap:
                continue
            current = heappop(heap)
            limit = min(
                heap[0].stamp_ns if heap else query.last_ns + 1,
                waiting[0].start_ns if waiting else query.last_ns + 1,
            )
            yield from self._run(current, limit, heap)

    @property
    def cached(self) -> Collection[int]:
        """Numbers of the chunks whose bytes are cached."""
        return self._cached.keys()

    def _run(
        self, current: _Open, limit_ns: int, heap: list[_Open]
    ) -> Iterator[tuple[Entry, bytes]]:
        """Read from one chunk until another one is due; at least one message."""
        data = self._bytes_of(current.chunk)
        entries, place = current.entries, current.place
        while True:
            entry = entries[place]
            yield entry, data[entry.begin : entry.end]
            place += 1
            if place == len(entries):
                self._forget(current.chunk)
                return
            stamp_ns = entries[place].stamp_ns
            if stamp_ns >= limit_ns:
                heappush(heap, current._replace(stamp_ns=stamp_ns, place=place))
                return

    def _open(self, chunk: Chunk, query: ChunkQuery, heap: list[_Open]) -> None:
        try:
            data = self._bytes_of(chunk)
            entries = self._file.parse_chunk(chunk, data)
            if not query.takes_all:
                entries = [entry for entry in entries if query.takes(entry)]
        except FileFormatError as error:
            if self._on_damage is None:
                raise
            self._on_damage(Damage(error.path, chunk.position, error.reason))
            return
        if entries:
            entries.sort(key=attrgetter("stamp_ns"))
            heappush(heap, _Open(entries[0].stamp_ns, chunk.number, 0, chunk, entries))
        else:
            self._forget(chunk)

    def _bytes_of(self, chunk: Chunk) -> bytes:
        found = self._cached.get(chunk.number)
        if found is None:
            found = self._file.read_chunk(chunk)
            self._cached[chunk.number] = found
            self._size += len(found)
            while self._size > self._cache_bytes and len(self._cached) > 1:
                self._size -= len(self._cached.popitem(last=False)[1])
        return found

    def _forget(self, chunk: Chunk) -> None:
        self._size -= len(self._cached.pop(chunk.number, b""))
