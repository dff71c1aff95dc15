"""Read the records of an MCAP file, with all lengths checked.

Source: the MCAP specification, version 0. The ``mcap`` library decodes schemas and
statistics; the numerous headers, channels, chunks and indexes are decoded here.
"""

import struct
import zlib
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel

from navette.bags.binary_file import BinaryFile
from navette.bags.chunks import Chunk, Entry
from navette.bags.compression import LARGEST, unpack
from navette.errors import DecodeError, FileFormatError

MAGIC = b"\x89MCAP0\r\n"
HEAD = struct.Struct("<BQ")
MESSAGE = struct.Struct("<HIQQ")
_MESSAGE_RECORD = struct.Struct("<BQHIQQ")
_CHUNK = struct.Struct("<QQQII")  # times, size, crc, length of the compression's name
_CHUNK_INDEX = struct.Struct("<QQQQI")
_LENGTH = struct.Struct("<Q")
_STRING = struct.Struct("<I")
_CHANNEL = struct.Struct("<HH")


class Head(NamedTuple):
    """Position of a record; its content spans ``begin`` to ``end`` (exclusive)."""

    opcode: int
    position: int
    begin: int
    end: int


class RecordFile(BinaryFile):
    """Record-wise access to an MCAP file."""

    def head(self, position: int) -> Head:
        opcode, length = HEAD.unpack(self.read(position, HEAD.size))
        begin = position + HEAD.size
        if length > self.size - begin:
            raise self.error(
                position, f"record of {length} bytes; the file ends at {self.size}"
            )
        return Head(opcode, position, begin, begin + length)

    def content(self, head: Head, limit: int = LARGEST) -> bytes:
        if head.end - head.begin > limit:
            raise self.error(head.position, f"record of {head.end - head.begin} bytes")
        return self.read(head.begin, head.end - head.begin)


def parse(kind: Any, content: bytes) -> Any:
    """Decode a record with the library's class.

    Raises:
        DecodeError: the content is invalid.
    """
    try:
        return kind.read(ReadDataStream(BytesIO(content)))
    except (McapError, struct.error, ValueError, MemoryError, OverflowError) as error:
        reason = str(error) or type(error).__name__
        raise DecodeError(f"not a valid {kind.__name__}: {reason}") from None


def chunk_head(file: RecordFile, head: Head) -> tuple[int, int, int, int, str, int]:
    """Times, unpacked size, CRC, compression and position of a chunk's data."""
    if head.end - head.begin < _CHUNK.size + _LENGTH.size:
        raise file.error(head.position, "chunk without a head")
    first, last, size, crc, length = _CHUNK.unpack(file.read(head.begin, _CHUNK.size))
    after = head.begin + _CHUNK.size
    if length > 32 or after + length + _LENGTH.size > head.end:
        raise file.error(head.position, "chunk whose compression has no name")
    tail = file.read(after, length + _LENGTH.size)
    compression = tail[:length].decode("ascii", "replace")
    data = after + length + _LENGTH.size
    (packed,) = _LENGTH.unpack_from(tail, length)
    if packed != head.end - data:
        raise file.error(head.position, f"chunk of {packed} bytes in another record")
    return first, last, size, crc, compression, data


def read_chunk(file: RecordFile, chunk: Chunk) -> bytes:
    """The records in a chunk, unpacked and checked.

    Raises:
        FileFormatError: there is no chunk, or it is damaged.
    """
    if chunk.bare:
        return file.read(chunk.position, chunk.length)
    head = file.head(chunk.position)
    if head.opcode != Opcode.CHUNK:
        raise file.error(chunk.position, f"record {head.opcode}, expected a chunk")
    _, _, size, crc, compression, data = chunk_head(file, head)
    try:
        unpacked = unpack(compression, file.read(data, head.end - data), size)
    except DecodeError as error:
        raise file.error(chunk.position, f"chunk: {error}") from error
    if crc and zlib.crc32(unpacked) != crc:
        raise file.error(chunk.position, "chunk: its checksum is another one")
    return unpacked


def records_in(path: Path, chunk: Chunk, data: bytes) -> Iterator[tuple[int, int, int]]:
    """Opcode, begin and end of the records in a chunk's bytes.

    Raises:
        FileFormatError: a record exceeds the chunk, or is of kind 0, which is invalid:
            a chunk of zeros is not a million records.
    """
    position = 0
    while position < len(data):
        found = _record_at(path, chunk, data, position)
        yield found
        position = found[2]


def _record_at(
    path: Path, chunk: Chunk, data: bytes, position: int
) -> tuple[int, int, int]:
    begin = position + HEAD.size
    opcode, length = HEAD.unpack_from(data, position) if begin <= len(data) else (0, 0)
    where = f"byte {chunk.position}: chunk"
    if begin + length > len(data):
        raise FileFormatError(path, f"{where} ends inside a record")
    if opcode == 0:
        raise FileFormatError(path, f"{where}, at {position}: record of kind 0")
    if opcode == Opcode.MESSAGE and length < MESSAGE.size:
        raise FileFormatError(path, f"{where}, at {position}: message without a head")
    return opcode, begin, begin + length


def message_entries(path: Path, chunk: Chunk, data: bytes) -> list[Entry]:
    """The messages in a chunk's bytes, as they lie."""
    entries: list[Entry] = []
    position, size, message = 0, len(data), int(Opcode.MESSAGE)
    unpack, head_size = _MESSAGE_RECORD.unpack_from, _MESSAGE_RECORD.size
    last = size - head_size
    while position < size:
        if position <= last and data[position] == message:
            _, length, channel, sequence, stamp, published = unpack(data, position)
            begin, end = position + head_size, position + HEAD.size + length
            if begin <= end <= size:
                entries.append(Entry(stamp, channel, begin, end, published, sequence))
                position = end
                continue
        position = _record_at(path, chunk, data, position)[2]
    return entries


def parse_channel(content: bytes) -> Channel:
    """A channel; in place of :func:`parse`, because a file may have 65,535.

    Raises:
        DecodeError: the content is not a channel.
    """
    try:
        number, schema = _CHANNEL.unpack_from(content)
        topic, position = _string_at(content, _CHANNEL.size)
        encoding, position = _string_at(content, position)
        (size,) = _STRING.unpack_from(content, position)
        position += _STRING.size
        end = position + size
        metadata = {}
        while position < end:
            key, position = _string_at(content, position)
            metadata[key], position = _string_at(content, position)
    except (struct.error, ValueError) as error:
        raise DecodeError(f"not a valid Channel: {error}") from None
    return Channel(number, topic, encoding, metadata, schema)


def _string_at(content: bytes, position: int) -> tuple[str, int]:
    """The string at a position, and the position after it."""
    (length,) = _STRING.unpack_from(content, position)
    begin = position + _STRING.size
    end = begin + length
    if end > len(content):
        raise ValueError(f"a string of {length} bytes at {position}")
    return content[begin:end].decode(), end


def parse_chunk_index(number: int, content: bytes) -> Chunk:
    """A chunk as the summary names it.

    Raises:
        DecodeError: the content is not a chunk index.
    """
    try:
        first, last, start, length, size = _CHUNK_INDEX.unpack_from(content)
        offsets = content[_CHUNK_INDEX.size : _CHUNK_INDEX.size + size]
        channels = frozenset(each[0] for each in struct.iter_unpack("<HQ", offsets))
        after = _CHUNK_INDEX.size + size + 8
        (name,) = _STRING.unpack_from(content, after)
        compression = content[after + 4 : after + 4 + name].decode("ascii")
    except (struct.error, ValueError) as error:
        raise DecodeError(f"no chunk index: {error}") from error
    return Chunk(number, start, length, first, last, compression, channels or None)


def parse_message_index(content: bytes) -> tuple[int, list[int]]:
    """Channel and stamps of its messages in one chunk.

    Raises:
        DecodeError: the content is not a message index.
    """
    try:
        channel, size = struct.unpack_from("<HI", content)
        if size > len(content) - 6 or size % 16:  # more may follow
            raise DecodeError(f"{size} bytes of message index in {len(content)}")
        numbers = struct.unpack_from(f"<{size // 8}Q", content, 6)
    except struct.error as error:
        raise DecodeError(f"no message index: {error}") from error
    return channel, list(numbers[::2])
