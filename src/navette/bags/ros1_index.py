"""Index of a ROS 1 bag, from its index records or from a scan."""

import re
import struct
from collections import Counter
from dataclasses import dataclass, field, replace
from functools import partial
from typing import NamedTuple

from navette.bags.binary_file import reason_of, walk
from navette.bags.chunks import Chunk, FileIndex
from navette.bags.ros1_records import (
    MAGIC,
    BagFile,
    Op,
    Record,
    message_entries,
    parse_fields,
    read_chunk,
    records_in,
    text,
    time_ns,
    uint32,
    uint64,
)
from navette.errors import DecodeError, FileFormatError

_MOST_RECORDS = 10_000_000
_OP_CHUNK = re.compile(rb"\x04\0\0\0op=\x05")
_LONGEST_HEADER = 64


class Connection(NamedTuple):
    """One publisher of one topic."""

    number: int
    topic: str
    type_name: str
    definition: str
    latching: bool


@dataclass
class BagIndex(FileIndex):
    """Adds connections by number."""

    counts: Counter[int] = field(default_factory=Counter)
    connections: dict[int, Connection] = field(default_factory=dict)


def read_index(file: BagFile) -> BagIndex:
    """Read the index if possible, else scan the records.

    Raises:
        FileFormatError: not a ROS 1 bag, or another version.
    """
    start = file.read(0, min(len(MAGIC), file.size))
    if start != MAGIC:
        if start.startswith((b"#ROSBAG V", b"#ROSRECORD")):
            version = start.split(b"\n")[0].decode("ascii", "replace")
            raise FileFormatError(
                file.path, f"{version}; only version 2.0 is supported"
            )
        raise FileFormatError(
            file.path, "is not a ROS 1 bag: the magic bytes are missing"
        )
    try:
        index, problem = _read_index_section(file), "the bag is not indexed"
    except (FileFormatError, DecodeError, struct.error) as error:
        index, problem = None, f"the index cannot be read ({reason_of(error)})"
    if index is None:
        index = scan(file)
        index.losses = tuple(index.problems)
        index.problems.insert(0, problem)
    return index


def _read_index_section(file: BagFile) -> BagIndex | None:
    header = file.record(len(MAGIC), wanted=Op.BAG_HEADER)
    position = uint64(header.fields, b"index_pos")
    connections = uint32(header.fields, b"conn_count")
    chunks = uint32(header.fields, b"chunk_count")
    if header.fields.get(b"encryptor"):
        raise FileFormatError(file.path, "is encrypted")
    if position == 0:
        return None
    if connections + chunks > _MOST_RECORDS:
        raise file.error(len(MAGIC), f"{connections} connections, {chunks} chunks")
    index = BagIndex()
    for _ in range(connections):
        record = file.record(position, wanted=Op.CONNECTION)
        connection = _connection(record, file.data(record))
        index.connections[connection.number] = connection
        position = record.end
    for number in range(chunks):
        record = file.record(position, wanted=Op.CHUNK_INFO)
        index.chunks.append(_chunk_of_info(file, number, record, index.counts))
        position = record.end
    index.chunks.sort(key=lambda chunk: chunk.position)
    return index


def _connection(record: Record, data: bytes) -> Connection:
    header = parse_fields(data)
    return Connection(
        uint32(record.fields, b"conn"),
        _topic_name(text(record.fields, b"topic")),
        text(header, b"type"),
        text(header, b"message_definition"),
        header.get(b"latching") == b"1",
    )


def _topic_name(name: str) -> str:
    """Return the name as in rosbag, without double or trailing slashes."""
    parts = [part for part in name.split("/") if part]
    return ("/" if name.startswith("/") else "") + "/".join(parts)


def _chunk_of_info(
    file: BagFile, number: int, record: Record, counts: Counter[int]
) -> Chunk:
    data = file.data(record)
    in_chunk = dict(struct.iter_unpack("<II", data))
    counts.update(in_chunk)
    position = uint64(record.fields, b"chunk_pos")
    chunk = file.record(position, wanted=Op.CHUNK)
    return Chunk(
        number,
        position,
        chunk.end - position,
        time_ns(record.fields, b"start_time") if in_chunk else 0,
        time_ns(record.fields, b"end_time") if in_chunk else 0,
        text(chunk.fields, b"compression"),
        frozenset(in_chunk),
    )


def scan(file: BagFile) -> BagIndex:
    """Build the index by scanning the records.

    The last chunk of a killed recorder has no length yet: its records are found as if
    they were outside any chunk. After a damaged record the scan resumes at the next
    chunk that can be found.
    """
    index = BagIndex(is_scanned=True)
    walker = _Walk(file, index)
    walk(file, len(MAGIC), walker.visit, partial(_next_chunk, file), index.problems)
    return index


def _next_chunk(file: BagFile, start: int) -> int | None:
    """Find the next intact chunk by its op field."""

    def chunk_of(position: int) -> int | None:
        # The field may be any of the three header fields.
        first = max(start, position - _LONGEST_HEADER)
        return next(
            (c for c in range(position - 4, first - 1, -1) if _is_chunk(file, c)), None
        )

    return file.find(start, _OP_CHUNK, chunk_of)


def _is_chunk(file: BagFile, position: int) -> bool:
    try:
        record = file.record(position, wanted=Op.CHUNK)
    except FileFormatError:
        return False
    return b"compression" in record.fields and b"size" in record.fields


class _Walk:
    """Collects the index during a scan."""

    def __init__(self, file: BagFile, index: BagIndex) -> None:
        self._file = file
        self._index = index

    def visit(self, position: int) -> int:
        """Process one record; return the next position."""
        record = self._file.record(position)
        if record.op == Op.CHUNK:
            self._chunk(record)
        elif record.op == Op.CONNECTION:
            self._note(_connection(record, self._file.data(record)))
        elif record.op == Op.MESSAGE:
            self._message(record)
        return record.end

    def _note(self, connection: Connection) -> None:
        self._index.connections.setdefault(connection.number, connection)

    def _chunk(self, record: Record) -> None:
        chunk = Chunk(
            len(self._index.chunks),
            record.position,
            record.end - record.position,
            0,
            0,
            text(record.fields, b"compression"),
        )
        try:
            data = read_chunk(self._file, chunk)
            for each in records_in(self._file.path, chunk, data):
                if each.op == Op.CONNECTION:
                    self._note(_connection(each, data[each.begin : each.end]))
            entries = message_entries(self._file.path, chunk, data)
        except (FileFormatError, DecodeError) as error:
            self._index.problems.append(reason_of(error))
            return
        if not entries:
            return
        stamps = [entry.stamp_ns for entry in entries]
        channels = Counter(entry.channel for entry in entries)
        self._index.counts.update(channels)
        self._index.chunks.append(
            replace(
                chunk,
                start_ns=min(stamps),
                end_ns=max(stamps),
                channels=frozenset(channels),
            )
        )

    def _message(self, record: Record) -> None:
        channel = uint32(record.fields, b"conn")
        stamp = time_ns(record.fields, b"time")
        self._index.counts[channel] += 1
        self._index.chunks.append(
            Chunk(
                len(self._index.chunks),
                record.position,
                record.end - record.position,
                stamp,
                stamp,
                channels=frozenset({channel}),
                bare=True,
            )
        )
