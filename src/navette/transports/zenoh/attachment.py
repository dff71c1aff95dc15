"""What travels beside each sample, request and reply: number, time, whose it is."""

import struct
from typing import NamedTuple

from navette.errors import DecodeError

# Sequence number, source time in ns, the length of the gid (always 16), the gid.
_LAYOUT = struct.Struct("<qqB16s")
SIZE = _LAYOUT.size
GID_SIZE = 16


class Attachment(NamedTuple):
    """The three values beside a sample."""

    sequence: int
    source_ns: int
    gid: bytes

    def encode(self) -> bytes:
        """33 bytes."""
        return _LAYOUT.pack(self.sequence, self.source_ns, GID_SIZE, self.gid)


def decode_attachment(data: bytes) -> Attachment:
    """The inverse of :meth:`Attachment.encode`.

    Raises:
        DecodeError: it is no attachment of that form.
    """
    if len(data) != SIZE:
        raise DecodeError(f"attachment of {len(data)} bytes, wanted {SIZE}")
    sequence, source_ns, size, gid = _LAYOUT.unpack(data)
    if size != GID_SIZE:
        raise DecodeError(f"attachment with a gid of {size} bytes, wanted {GID_SIZE}")
    if sequence < 0:
        raise DecodeError(f"attachment with the sequence number {sequence}")
    return Attachment(sequence, source_ns, gid)
