"""Attachments and metadata records of an MCAP file."""

import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import partial
from typing import NamedTuple

from mcap.opcode import Opcode
from mcap.records import AttachmentIndex, Metadata, MetadataIndex

from navette.bags.bag import BagAttachment, MetadataRecord
from navette.bags.mcap_records import MAGIC, Head, RecordFile, parse
from navette.errors import DecodeError, FileFormatError

_TIMES = struct.Struct("<QQ")
_LENGTH = struct.Struct("<I")
_SIZE = struct.Struct("<Q")
_LONGEST_NAME = 1 << 16
_LARGEST_METADATA = 16 << 20
_BLOCK = 1 << 20


@dataclass
class ExtraPositions:
    """Positions of the records; and how many the statistics state."""

    attachments: list[int] = field(default_factory=list)
    metadata: list[int] = field(default_factory=list)
    stated: tuple[int, int] | None = None

    @property
    def is_complete(self) -> bool:
        return self.stated == (len(self.attachments), len(self.metadata))

    def note_index(self, opcode: int, content: bytes) -> None:
        """Store the position in a record of the summary."""
        if opcode == Opcode.ATTACHMENT_INDEX:
            self.attachments.append(parse(AttachmentIndex, content).offset)
        elif opcode == Opcode.METADATA_INDEX:
            self.metadata.append(parse(MetadataIndex, content).offset)

    def note_record(self, head: Head) -> None:
        """Store the position of a record of the data section."""
        if head.opcode == Opcode.ATTACHMENT:
            self.attachments.append(head.position)
        elif head.opcode == Opcode.METADATA:
            self.metadata.append(head.position)


def scan_for_extras(file: RecordFile) -> ExtraPositions:
    """Find the records by their heads, up to the first damaged one."""
    found = ExtraPositions()
    position = len(MAGIC)
    try:
        while position < file.size:
            head = file.head(position)
            if head.opcode in (0, Opcode.DATA_END, Opcode.FOOTER):
                break
            found.note_record(head)
            position = head.end
    except FileFormatError:
        pass  # reported on opening
    return found


class AttachmentHead(NamedTuple):
    """Fields of an attachment before its content."""

    log_ns: int
    create_ns: int
    name: str
    media_type: str
    size: int
    begin: int
    """Position of the content, relative to the record's content."""

    @classmethod
    def parse(cls, start: bytes) -> "AttachmentHead":
        """Parse the first bytes of a record's content.

        Raises:
            struct.error: too short.
        """
        log_ns, create_ns = _TIMES.unpack_from(start)
        name, position = _text(start, _TIMES.size)
        media_type, position = _text(start, position)
        (size,) = _SIZE.unpack_from(start, position)
        begin = position + _SIZE.size
        return cls(log_ns, create_ns, name, media_type, size, begin)


def _text(data: bytes, position: int) -> tuple[str, int]:
    (length,) = _LENGTH.unpack_from(data, position)
    begin = position + _LENGTH.size
    if length > _LONGEST_NAME or begin + length > len(data):
        raise struct.error(f"a text of {length} bytes")
    return data[begin : begin + length].decode("utf-8", "replace"), begin + length


def read_attachment(file: RecordFile, position: int) -> BagAttachment:
    """Read the head of an attachment.

    Raises:
        FileFormatError: it does not exist, or it is damaged.
    """
    head = file.head(position)
    if head.opcode != Opcode.ATTACHMENT:
        raise file.error(position, f"record {head.opcode}, expected an attachment")
    length = head.end - head.begin
    start = file.read(head.begin, min(length, 2 * _LONGEST_NAME + 64))
    try:
        found = AttachmentHead.parse(start)
    except struct.error as error:
        raise file.error(position, f"attachment: {error}") from error
    if found.begin + found.size + 4 > length:  # more may follow
        raise file.error(
            position, f"attachment of {found.size} bytes in a record of {length}"
        )
    return BagAttachment(
        found.name,
        found.media_type,
        found.size,
        found.log_ns,
        found.create_ns,
        partial(_blocks, file, head.position, head.begin, found),
    )


def _blocks(
    file: RecordFile, position: int, start: int, head: AttachmentHead
) -> Iterator[bytes]:
    """Yield the record's content; raises at its end if its checksum does not match."""
    crc, end = 0, start + head.begin + head.size
    for begin in range(start, end, _BLOCK):
        block = file.read(begin, min(_BLOCK, end - begin))
        crc = zlib.crc32(block, crc)
        yield block
    stated = file.read(end, 4)
    if any(stated) and stated != crc.to_bytes(4, "little"):
        raise file.error(position, "attachment: its checksum does not match")
    yield stated


def read_metadata_record(file: RecordFile, position: int) -> MetadataRecord:
    """Read a metadata record.

    Raises:
        FileFormatError: it does not exist, or it is damaged.
    """
    head = file.head(position)
    if head.opcode != Opcode.METADATA:
        raise file.error(position, f"record {head.opcode}, expected metadata")
    try:
        found: Metadata = parse(Metadata, file.content(head, _LARGEST_METADATA))
    except DecodeError as error:
        raise file.error(position, str(error)) from error
    return MetadataRecord(found.name, found.metadata)
