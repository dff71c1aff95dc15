"""Write a chunked MCAP file record by record.

Source: the MCAP specification, version 0 (foxglove/mcap, website/docs/spec). Records
are encoded by the ``mcap`` library; its own writer is not used because it takes four
times as long per message.
"""

import struct
import zlib
from collections.abc import Callable, Mapping, Sequence
from tempfile import SpooledTemporaryFile
from typing import IO, Any

import zstandard
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    AttachmentIndex,
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)

from navette.bags.bag import BagAttachment
from navette.bags.mcap_records import MAGIC
from navette.errors import InvalidValueError

COMPRESSIONS = ("zstd", "lz4", "none")
# Opcode, content length; channel, sequence, log time, publish time (ns).
_MESSAGE = struct.Struct("<BQHIQQ")
_MESSAGE_HEAD = _MESSAGE.size - 9
# Opcode, content length; channel, bytes of the entries that follow.
_INDEX = struct.Struct("<BQHI")
_RECORD_HEAD = struct.Struct("<BQ")
_MOST_IDS = 2**16 - 1
_SPOOL_BYTES = 1 << 20
_FOOTER_START = struct.Struct("<BQQQ")
# Maximum bytes: end of data, statistics, offsets and footer; index of a chunk; entries
# of a channel in the chunk index and statistics.
_INDEX_BASE, _CHUNK_INDEX_BASE, _PER_CHANNEL = 256, 90, 10


class McapFile:
    """Writes to ``stream``; the bytes depend only on the added messages.

    Messages are collected in a chunk until :meth:`end_chunk`.

    Args:
        compression: of the chunks, one of :data:`COMPRESSIONS`.
    """

    def __init__(
        self,
        stream: IO[bytes],
        *,
        profile: str,
        library: str,
        compression: str = "zstd",
    ) -> None:
        #: Target of all bytes; may be replaced between two writes.
        self.stream = stream
        self._position = 0
        self._schemas: list[Schema] = []
        self._channels: list[Channel] = []
        self._attachments: list[AttachmentIndex] = []
        self._metadata: list[MetadataIndex] = []
        #: Messages by channel.
        self._counts: list[int] = [0]
        self._compression = "" if compression == "none" else compression
        self._compress = _compressor(compression)
        self._chunk_indexes: list[ChunkIndex] = []
        #: Messages by channel for each finished chunk.
        self._chunk_counts: list[dict[int, int]] = []
        self._parts: list[bytes] = []
        self._index: dict[int, list[int]] = {}
        #: Upper bound of the bytes that :meth:`finish` writes after the last chunk.
        self.index_size = _INDEX_BASE
        #: Size of the current chunk, bytes.
        self.chunk_size = 0
        self._write(MAGIC + _record(Header(profile=profile, library=library)))
        self._data_start = self._position

    @property
    def message_count(self) -> int:
        return sum(self._counts)

    @property
    def size(self) -> int:
        """Bytes written, plus the uncompressed current chunk."""
        return self._position + self.chunk_size

    def add_schema(self, name: str, encoding: str, data: bytes) -> int:
        """Return the schema id for :meth:`add_channel`."""
        number = _next_id(self._schemas, "schemas")
        schema = Schema(id=number, name=name, encoding=encoding, data=data)
        self._schemas.append(schema)
        self._add_to_both(_record(schema))
        return number

    def add_channel(
        self, topic: str, encoding: str, schema: int, metadata: dict[str, str]
    ) -> int:
        """Return the channel id for :meth:`add_message`."""
        number = _next_id(self._channels, "channels")
        channel = Channel(
            id=number,
            topic=topic,
            message_encoding=encoding,
            schema_id=schema,
            metadata=metadata,
        )
        self._channels.append(channel)
        self._counts.append(0)
        self._add_to_both(_record(channel))
        return number

    def add_message(self, channel: int, stamp_ns: int, payload: bytes) -> None:
        """Append a message; its sequence is its number in the channel, from 1."""
        self._counts[channel] = sequence = self._counts[channel] + 1
        length = _MESSAGE_HEAD + len(payload)
        index = self._index.setdefault(channel, [])
        index.append(stamp_ns)
        index.append(self.chunk_size)
        head = _MESSAGE.pack(5, length, channel, sequence, stamp_ns, stamp_ns)
        self._parts.append(head)
        self._parts.append(payload)
        self.chunk_size += 9 + length

    def set_recorded(self, publish_ns: int | None, sequence: int | None) -> None:
        """Give the last message its recorded time of publication and sequence."""
        parts = list(_MESSAGE.unpack(self._parts[-2]))
        if sequence is not None:
            parts[3] = sequence
        if publish_ns is not None:
            parts[5] = publish_ns
        self._parts[-2] = _MESSAGE.pack(*parts)

    def add_attachment(self, attachment: BagAttachment) -> None:
        """Write an attachment, between chunks."""
        length = 0
        position = self._position
        with SpooledTemporaryFile(max_size=_SPOOL_BYTES) as spool:
            for block in attachment.blocks():
                length += len(block)
                spool.write(block)
            spool.seek(0)
            self._write(_RECORD_HEAD.pack(Opcode.ATTACHMENT, length))
            while block := spool.read(_SPOOL_BYTES):
                self._write(block)
        self._add_index(
            self._attachments,
            AttachmentIndex(
                offset=position,
                length=self._position - position,
                log_time=attachment.log_ns,
                create_time=attachment.create_ns,
                data_size=attachment.size,
                name=attachment.name,
                media_type=attachment.media_type,
            ),
        )

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Write a metadata record, between chunks."""
        record = _record(Metadata(name=name, metadata=dict(values)))
        index = MetadataIndex(offset=self._position, length=len(record), name=name)
        self._write(record)
        self._add_index(self._metadata, index)

    def _add_index(self, indexes: list[Any], index: McapRecord) -> None:
        indexes.append(index)
        self.index_size += len(_record(index))

    def end_chunk(self) -> None:
        """Write the chunk and its index, if it has messages."""
        if not self._index:
            return
        content = b"".join(self._parts)
        packed = self._compress(content)
        stamps = [stamp for index in self._index.values() for stamp in index[::2]]
        chunk = Chunk(
            compression=self._compression,
            data=packed,
            message_start_time=min(stamps),
            message_end_time=max(stamps),
            uncompressed_crc=zlib.crc32(content),
            uncompressed_size=len(content),
        )
        chunk_start = self._position
        record = _record(chunk)
        indexes, offsets = self._message_indexes(chunk_start + len(record))
        self._write(record + indexes)
        self._chunk_indexes.append(
            ChunkIndex(
                chunk_length=len(record),
                chunk_start_offset=chunk_start,
                compression=chunk.compression,
                compressed_size=len(packed),
                message_end_time=chunk.message_end_time,
                message_index_length=len(indexes),
                message_index_offsets=offsets,
                message_start_time=chunk.message_start_time,
                uncompressed_size=chunk.uncompressed_size,
            )
        )
        self.index_size += _CHUNK_INDEX_BASE + _PER_CHANNEL * len(offsets)
        counts = {channel: len(index) // 2 for channel, index in self._index.items()}
        self._chunk_counts.append(counts)
        self._parts, self._index, self.chunk_size = [], {}, 0

    def keep(self, size: int) -> int:
        """Forget the chunks that are not within the first ``size`` bytes of the file.

        Returns the size of the remaining chunks, to which the file must be truncated.
        """
        self._parts, self._index, self.chunk_size = [], {}, 0
        while self._chunk_indexes and _end(self._chunk_indexes[-1]) > size:
            self._chunk_indexes.pop()
            self._chunk_counts.pop()
        self._counts = [0] + [
            sum(counts.get(channel.id, 0) for counts in self._chunk_counts)
            for channel in self._channels
        ]
        chunks = self._chunk_indexes
        self._position = _end(chunks[-1]) if chunks else self._data_start
        return self._position

    @property
    def written(self) -> int:
        """Bytes passed to the stream."""
        return self._position

    def finish(self, stream: IO[bytes] | None = None) -> None:
        """End the last chunk and write the summary; the stream stays open.

        Args:
            stream: replaces the stream for the rest of the file, if given.
        """
        self.stream = stream or self.stream
        self.end_chunk()
        self._write(_record(DataEnd(data_section_crc=0)))
        summary_start = self._position
        summary, offsets = self._summary()
        offset_start = summary_start + len(summary)
        summary += b"".join(map(_record, offsets))
        start = _FOOTER_START.pack(Opcode.FOOTER, 20, summary_start, offset_start)
        footer = Footer(
            summary_start=summary_start,
            summary_offset_start=offset_start,
            summary_crc=zlib.crc32(start, zlib.crc32(summary)),
        )
        self._write(summary + _record(footer) + MAGIC)

    def _message_indexes(self, position: int) -> tuple[bytes, dict[int, int]]:
        parts: list[bytes] = []
        offsets: dict[int, int] = {}
        for channel, index in self._index.items():
            offsets[channel] = position
            size = 8 * len(index)
            head = _INDEX.pack(Opcode.MESSAGE_INDEX, 6 + size, channel, size)
            part = head + struct.pack(f"<{len(index)}Q", *index)
            parts.append(part)
            position += len(part)
        return b"".join(parts), offsets

    def _summary(self) -> tuple[bytes, list[SummaryOffset]]:
        groups: tuple[tuple[Opcode, list[McapRecord]], ...] = (
            (Opcode.SCHEMA, list(self._schemas)),
            (Opcode.CHANNEL, list(self._channels)),
            (Opcode.STATISTICS, [self._statistics()]),
            (Opcode.CHUNK_INDEX, list(self._chunk_indexes)),
            (Opcode.ATTACHMENT_INDEX, list(self._attachments)),
            (Opcode.METADATA_INDEX, list(self._metadata)),
        )
        summary = b""
        offsets = []
        for opcode, records in groups:
            group = b"".join(map(_record, records))
            if group:
                start = self._position + len(summary)
                offsets.append(
                    SummaryOffset(
                        group_opcode=opcode, group_start=start, group_length=len(group)
                    )
                )
            summary += group
        return summary, offsets

    def _statistics(self) -> Statistics:
        chunks = self._chunk_indexes
        counts = {n: count for n, count in enumerate(self._counts) if count}
        return Statistics(
            attachment_count=len(self._attachments),
            channel_count=len(self._channels),
            channel_message_counts=counts,
            chunk_count=len(chunks),
            message_count=self.message_count,
            message_start_time=min((c.message_start_time for c in chunks), default=0),
            message_end_time=max((c.message_end_time for c in chunks), default=0),
            metadata_count=len(self._metadata),
            schema_count=len(self._schemas),
        )

    def _add_to_both(self, record: bytes) -> None:
        self._parts.append(record)
        self.chunk_size += len(record)
        self.index_size += len(record) + _PER_CHANNEL

    def _write(self, data: bytes) -> None:
        self.stream.write(data)
        self._position += len(data)


def _next_id(known: Sequence[object], what: str) -> int:
    """Return the id of the next schema or channel: 16 bits, from 1."""
    if len(known) >= _MOST_IDS:
        raise InvalidValueError(f"more than {_MOST_IDS} {what} in one .mcap file")
    return len(known) + 1


def _end(chunk: ChunkIndex) -> int:
    """Offset after the chunk and its message indexes."""
    return chunk.chunk_start_offset + chunk.chunk_length + chunk.message_index_length


def _compressor(kind: str) -> Callable[[bytes], bytes]:
    if kind == "zstd":
        packer = zstandard.ZstdCompressor()
        return packer.compress
    if kind == "lz4":
        import lz4.frame

        return lz4.frame.compress  # type: ignore[no-any-return] # lz4 has no types
    return bytes


def _record(record: McapRecord) -> bytes:
    builder: Any = RecordBuilder()  # its methods carry no types
    record.write(builder)
    return bytes(builder.end())
