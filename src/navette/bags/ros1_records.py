"""Read the records of a ROS 1 bag, version 2.0, with all lengths checked.

Source: wiki.ros.org/Bags/Format/2.0.
"""

import struct
from collections.abc import Iterator
from enum import IntEnum
from pathlib import Path
from typing import NamedTuple

from navette.bags.binary_file import BinaryFile
from navette.bags.chunks import Chunk, Entry
from navette.bags.compression import LARGEST, unpack
from navette.errors import DecodeError, FileFormatError

MAGIC = b"#ROSBAG V2.0\n"
_UINT32 = struct.Struct("<I")
_TIME = struct.Struct("<II")
_LARGEST_HEADER = 1 << 20

Fields = dict[bytes, bytes]


class Op(IntEnum):
    MESSAGE = 2
    BAG_HEADER = 3
    INDEX = 4
    CHUNK = 5
    CHUNK_INFO = 6
    CONNECTION = 7


class Record(NamedTuple):
    """Header of a record and the position of its data."""

    op: int
    fields: Fields
    position: int
    begin: int
    end: int


class BagFile(BinaryFile):
    def record(self, position: int, *, wanted: Op | None = None) -> Record:
        """Read the record header at a position; the data is not read."""
        (length,) = _UINT32.unpack(self.read(position, 4))
        if length > _LARGEST_HEADER:
            raise self.error(position, f"record header of {length} bytes")
        header = self.read(position + 4, length + 4)
        try:
            fields = parse_fields(header[:length])
            op = uint8(fields, b"op")
        except DecodeError as error:
            raise self.error(position, str(error)) from error
        (size,) = _UINT32.unpack_from(header, length)
        begin = position + 8 + length
        if begin + size > self.size:
            raise self.error(
                position, f"record of {size} bytes; the file ends at {self.size}"
            )
        if wanted is not None and op != wanted:
            raise self.error(position, f"record {op}, expected {wanted.name.lower()}")
        return Record(op, fields, position, begin, begin + size)

    def data(self, record: Record) -> bytes:
        return self.read(record.begin, record.end - record.begin)


def parse_fields(header: bytes | memoryview) -> Fields:
    """Parse the fields of a record header.

    Raises:
        DecodeError: a field exceeds the header, or has no name.
    """
    header = bytes(header)
    fields: Fields = {}
    position, size = 0, len(header)
    while position < size:
        if position + 4 > size:
            raise DecodeError("record header ends inside a field")
        (length,) = _UINT32.unpack_from(header, position)
        position += 4
        field = header[position : position + length]
        position += length
        name, equals, value = field.partition(b"=")
        if position > size or not equals:
            raise DecodeError("record header with an invalid field")
        fields[name] = value
    return fields


def uint8(fields: Fields, name: bytes) -> int:
    return _field(fields, name, 1)[0]


def uint32(fields: Fields, name: bytes) -> int:
    return int.from_bytes(_field(fields, name, 4), "little")


def uint64(fields: Fields, name: bytes) -> int:
    return int.from_bytes(_field(fields, name, 8), "little")


def time_ns(fields: Fields, name: bytes) -> int:
    seconds, rest = _TIME.unpack(_field(fields, name, 8))
    stamp: int = seconds * 1_000_000_000 + rest
    return stamp


def text(fields: Fields, name: bytes) -> str:
    """Read a text field; invalid UTF-8 is replaced."""
    if name not in fields:
        raise DecodeError(f"record without {name.decode()!r}")
    return fields[name].decode("utf-8", "replace")


def _field(fields: Fields, name: bytes, size: int) -> bytes:
    found = fields.get(name)
    if found is None or len(found) != size:
        raise DecodeError(f"record without {name.decode()!r} of {size} bytes")
    return found


def read_chunk(file: BagFile, chunk: Chunk) -> bytes:
    """Return the uncompressed records of a chunk.

    Raises:
        FileFormatError: missing or damaged chunk.
    """
    if chunk.bare:
        return file.read(chunk.position, chunk.length)
    record = file.record(chunk.position, wanted=Op.CHUNK)
    try:
        size = uint32(record.fields, b"size")
        kind = text(record.fields, b"compression")
        if record.end - record.begin > LARGEST:
            raise DecodeError(f"{record.end - record.begin} compressed bytes")
        return unpack(kind, file.data(record), size)
    except DecodeError as error:
        raise file.error(chunk.position, f"chunk: {error}") from error


def records_in(path: Path, chunk: Chunk, data: bytes) -> Iterator[Record]:
    """Iterate over the records in a chunk's bytes; positions are relative to it."""
    view = memoryview(data)
    position, size = 0, len(data)
    while position < size:
        try:
            record = _record_at(view, position, size)
        except (DecodeError, struct.error) as error:
            raise FileFormatError(
                path, f"byte {chunk.position}: chunk, at {position}: {error}"
            ) from None
        yield record
        position = record.end


def _record_at(data: memoryview, position: int, size: int) -> Record:
    (length,) = _UINT32.unpack_from(data, position)
    begin = position + 8 + length
    if begin > size:
        raise DecodeError("ends inside a record")
    fields = parse_fields(data[position + 4 : position + 4 + length])
    (data_size,) = _UINT32.unpack_from(data, position + 4 + length)
    if begin + data_size > size:
        raise DecodeError("ends inside a record")
    return Record(uint8(fields, b"op"), fields, position, begin, begin + data_size)


def message_entries(path: Path, chunk: Chunk, data: bytes) -> list[Entry]:
    """Iterate over the messages in a chunk's bytes, in file order."""
    entries: list[Entry] = []
    for record in records_in(path, chunk, data):
        if record.op == Op.MESSAGE:
            try:
                stamp = time_ns(record.fields, b"time")
                channel = uint32(record.fields, b"conn")
            except DecodeError as error:
                raise FileFormatError(
                    path, f"byte {chunk.position}: chunk: {error}"
                ) from error
            entries.append(Entry(stamp, channel, record.begin, record.end))
    return entries
