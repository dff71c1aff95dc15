"""Attachment of each sample, request and reply: sequence number, time and gid."""

import struct
from typing import NamedTuple

from navette.errors import DecodeError

# Sequence number, source time in ns, the length of the gid (always 16), the gid.
_LAYOUT = struct.Struct("<qqB16s")
SIZE = _LAYOUT.size
GID_SIZE = 16


class Attachment(NamedTuple):
    """Sequence number, source time and gid of a sample's sender."""

    sequence: int
    source_ns: int
    gid: bytes

    def encode(self) -> bytes:
        return _LAYOUT.pack(self.sequence, self.source_ns, GID_SIZE, self.gid)


def decode_attachment(data: bytes) -> Attachment:
    """Decode an attachment.

    Raises:
        DecodeError: ``data`` is not such an attachment.
    """
    if len(data) != SIZE:
        raise DecodeError(f"attachment of {len(data)} bytes, expected {SIZE}")
    sequence, source_ns, size, gid = _LAYOUT.unpack(data)
    if size != GID_SIZE:
        raise DecodeError(f"attachment with a gid of {size} bytes, expected {GID_SIZE}")
    if sequence < 0:
        raise DecodeError(f"attachment with the negative sequence number {sequence}")
    return Attachment(sequence, source_ns, gid)
