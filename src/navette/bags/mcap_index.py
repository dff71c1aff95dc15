"""Index of an MCAP file, from its summary or from a scan of its records."""

import re
import zlib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import partial

from mcap.opcode import Opcode
from mcap.records import Channel, Footer, Header, Schema, Statistics

from navette.bags.binary_file import reason_of, walk
from navette.bags.chunks import Chunk, FileIndex
from navette.bags.mcap_extras import ExtraPositions
from navette.bags.mcap_records import (
    HEAD,
    MAGIC,
    MESSAGE,
    Head,
    RecordFile,
    chunk_head,
    parse,
    parse_channel,
    parse_chunk_index,
    parse_message_index,
    read_chunk,
    records_in,
)
from navette.errors import DecodeError, FileFormatError

_FOOTER_SIZE = HEAD.size + 20
_LARGEST_SUMMARY = 1 << 30
_BARE_BYTES = 1 << 20
# Opcodes of the specification; those from 0x80 on are application-defined.
_OPCODES = frozenset(range(1, 0x10)) | frozenset(range(0x80, 0x100))
_COMPRESSION = re.compile(rb"\x04\0\0\0zstd|\x03\0\0\0lz4")
# Offset of the compression field in a chunk: opcode, length, times, size, checksum.
_TO_COMPRESSION = 9 + 28


@dataclass
class McapIndex(FileIndex):
    """Adds schemas and channels by number."""

    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    extras: ExtraPositions = field(default_factory=ExtraPositions)
    profile: str = ""
    has_data_end: bool = False


def read_index(file: RecordFile) -> McapIndex:
    """Build the index from the summary if possible, else by scanning.

    Raises:
        FileFormatError: not an MCAP file.
    """
    if file.size < len(MAGIC) or file.read(0, len(MAGIC)) != MAGIC:
        raise FileFormatError(
            file.path, "is not an MCAP file: the magic bytes are missing"
        )
    try:
        index, statistics = _read_summary(file)
    except (FileFormatError, DecodeError) as error:
        index = scan(file)
        index.losses = tuple(index.problems)
        problem = f"the summary cannot be read ({reason_of(error)})"
        index.problems.insert(0, problem)
        return index
    if index is not None:
        return index
    index = scan(file)
    index.problems += _contradictions(index, statistics)
    index.losses = tuple(index.problems)
    if not index.problems:
        index.remarks.append("the file has no complete summary: all of it is read")
    return index


def _contradictions(index: McapIndex, statistics: Statistics | None) -> Iterator[str]:
    """Yield what the records of an undamaged file lack."""
    if not index.has_data_end:
        yield "the record at the end of the data is missing"
    if statistics is None or index.counts is None:
        return
    found = sum(index.counts.values())
    if found != statistics.message_count:
        yield f"messages in the file: {found} of {statistics.message_count}"


def _read_summary(file: RecordFile) -> tuple[McapIndex | None, Statistics | None]:
    """Read the optional summary; no index if messages cannot be found with it.

    Raises:
        DecodeError, FileFormatError: footer or summary are missing or damaged.
    """
    tail = len(MAGIC) + _FOOTER_SIZE
    if file.size < len(MAGIC) + tail or file.read(file.size - 8, 8) != MAGIC:
        raise FileFormatError(file.path, "the footer is missing")
    position = file.size - tail
    head = file.head(position)
    footer: Footer = parse(Footer, file.content(head))
    if head.opcode != Opcode.FOOTER:
        raise file.error(position, "no footer")
    if footer.summary_start == 0:
        return None, None
    length = position - footer.summary_start
    if not 0 <= length <= _LARGEST_SUMMARY:
        raise file.error(position, f"a summary of {length} bytes")
    summary = file.read(footer.summary_start, length)
    if footer.summary_crc:
        start = file.read(position, _FOOTER_SIZE - 4)
        if zlib.crc32(start, zlib.crc32(summary)) != footer.summary_crc:
            raise file.error(footer.summary_start, "its checksum does not match")
    return _index_of_summary(file, footer.summary_start, summary)


def _index_of_summary(
    file: RecordFile, start: int, summary: bytes
) -> tuple[McapIndex | None, Statistics | None]:
    index = McapIndex()
    _read_header(file, index)
    statistics: Statistics | None = None
    whole = Chunk(0, start, len(summary), 0, 0)
    for opcode, begin, end in records_in(file.path, whole, summary):
        content = summary[begin:end]
        if opcode == Opcode.CHUNK_INDEX:
            index.chunks.append(parse_chunk_index(len(index.chunks), content))
        elif opcode == Opcode.STATISTICS:
            statistics = parse(Statistics, content)
        else:
            index.extras.note_index(opcode, content)
            _note(index, opcode, content)
    index.chunks.sort(key=lambda chunk: chunk.position)
    if statistics is None or not _is_complete(index, statistics):
        return None, statistics
    index.counts = Counter(statistics.channel_message_counts)
    index.extras.stated = statistics.attachment_count, statistics.metadata_count
    return index, statistics


def _is_complete(index: McapIndex, statistics: Statistics) -> bool:
    """Whether the summary is sufficient to read all messages."""
    counts = statistics.channel_message_counts
    return (
        len(index.chunks) == statistics.chunk_count
        and (bool(index.chunks) or statistics.message_count == 0)
        and set(counts) <= set(index.channels)
        and sum(counts.values()) == statistics.message_count
        and all(c.schema_id in {0, *index.schemas} for c in index.channels.values())
    )


def _read_header(file: RecordFile, index: McapIndex) -> int:
    head = file.head(len(MAGIC))
    if head.opcode != Opcode.HEADER:
        index.problems.append("the header is missing")
        return head.position
    try:
        header: Header = parse(Header, file.content(head, 1 << 16))
        index.profile = header.profile
    except (DecodeError, FileFormatError) as error:
        index.problems.append(f"the header cannot be read ({error})")
    return head.end


def _note(index: McapIndex, opcode: int, content: bytes) -> None:
    """Store a schema or a channel; the first of an id wins."""
    if opcode == Opcode.SCHEMA:
        schema: Schema = parse(Schema, content)
        index.schemas.setdefault(schema.id, schema)
    elif opcode == Opcode.CHANNEL:
        channel = parse_channel(content)
        index.channels.setdefault(channel.id, channel)


def scan(file: RecordFile) -> McapIndex:
    """Build the index by scanning the records.

    Chunks are decompressed only if they contain unknown schemas or channels. After a
    damaged record the scan resumes at the next chunk that can be found.
    """
    index = McapIndex(counts=Counter(), is_scanned=True)
    walker = _Walk(file, index)
    start = len(MAGIC)
    try:
        start = _read_header(file, index)
    except FileFormatError as error:
        index.problems.append(f"the header cannot be read ({error.reason})")
    walk(file, start, walker.visit, partial(_next_chunk, file), index.problems)
    found = index.extras
    found.stated = len(found.attachments), len(found.metadata)
    return index


def _next_chunk(file: RecordFile, start: int) -> int | None:
    """Find the next intact chunk header by the name of its compression."""

    def chunk_of(position: int) -> int | None:
        candidate = position - _TO_COMPRESSION
        if candidate < start:
            return None
        try:
            head = file.head(candidate)
            if head.opcode == Opcode.CHUNK:
                chunk_head(file, head)
                return candidate
        except FileFormatError:
            pass  # false match
        return None

    return file.find(start, _COMPRESSION, chunk_of)


class _Walk:
    """Collects the index during a scan."""

    def __init__(self, file: RecordFile, index: McapIndex) -> None:
        self._file = file
        self._index = index

    def visit(self, position: int) -> int | None:
        """Process one record; return the next position, None at the end of the data."""
        head = self._file.head(position)
        if head.opcode in (Opcode.DATA_END, Opcode.FOOTER):
            self._index.has_data_end = head.opcode == Opcode.DATA_END
            return None
        if head.opcode not in _OPCODES:
            raise self._file.error(position, f"record of kind {head.opcode}")
        if head.opcode == Opcode.CHUNK:
            self._chunk(head)
        elif head.opcode == Opcode.MESSAGE:
            self._message(head)
        elif head.opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
            _note(self._index, head.opcode, self._file.content(head))
        else:
            self._index.extras.note_record(head)
        return head.end

    def _chunk(self, head: Head) -> None:
        first, last, _, _, compression, _ = chunk_head(self._file, head)
        try:
            by_channel = read_message_indexes(self._file, head.end)
        except (FileFormatError, DecodeError):
            by_channel = {}  # the indexes are damaged; the chunk itself may be intact
        known = by_channel.keys() <= self._index.channels.keys()
        chunk = Chunk(
            len(self._index.chunks),
            head.position,
            head.end - head.position,
            first,
            last,
            compression,
            frozenset(by_channel) or None,
        )
        if not by_channel or not known:
            self._look_into(chunk)
        self._index.chunks.append(chunk)
        if not by_channel:
            self._index.counts = None
        if self._index.counts is not None:
            for channel, stamps in by_channel.items():
                self._index.counts[channel] += len(stamps)

    def _look_into(self, chunk: Chunk) -> None:
        try:
            data = read_chunk(self._file, chunk)
            for opcode, begin, end in records_in(self._file.path, chunk, data):
                if opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
                    _note(self._index, opcode, data[begin:end])
        except FileFormatError as error:
            self._index.problems.append(error.reason)
        except DecodeError as error:
            self._index.problems.append(f"byte {chunk.position}: chunk: {error}")

    def _message(self, head: Head) -> None:
        """Add a message outside chunks; adjacent ones form a bare chunk."""
        if head.end - head.begin < MESSAGE.size:
            raise self._file.error(head.position, "message without a header")
        channel, _, stamp, _ = MESSAGE.unpack(self._file.read(head.begin, MESSAGE.size))
        chunks, counts = self._index.chunks, self._index.counts
        length = head.end - head.position
        if counts is not None:
            counts[channel] += 1
        last = chunks[-1] if chunks else None
        if (
            last is not None
            and last.bare
            and last.position + last.length == head.position
            and last.length + length <= _BARE_BYTES
        ):
            chunks[-1] = replace(
                last,
                length=last.length + length,
                start_ns=min(last.start_ns, stamp),
                end_ns=max(last.end_ns, stamp),
                channels=(last.channels or frozenset()) | {channel},
            )
            return
        chunks.append(
            Chunk(
                len(chunks),
                head.position,
                length,
                stamp,
                stamp,
                channels=frozenset({channel}),
                bare=True,
            )
        )


def read_message_indexes(file: RecordFile, position: int) -> dict[int, list[int]]:
    """Return stamps by channel from the indexes after a chunk; {} without any."""
    found: dict[int, list[int]] = {}
    while position + HEAD.size <= file.size:
        head = file.head(position)
        if head.opcode != Opcode.MESSAGE_INDEX:
            break
        channel, stamps = parse_message_index(file.content(head))
        if stamps:
            found.setdefault(channel, []).extend(stamps)
        position = head.end
    return found
