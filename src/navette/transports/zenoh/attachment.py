"""Attachment of each sample, request and reply, and limit of their payloads."""

import struct
from typing import NamedTuple

import zenoh

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


def check_length(payload: zenoh.ZBytes, max_bytes: int) -> None:
    """Check the length of a payload before it is copied.

    Raises:
        DecodeError: it is longer than ``max_bytes``.
    """
    if len(payload) > max_bytes:
        raise DecodeError(
            f"{len(payload)} bytes: longer than {max_bytes} (NAVETTE_MAX_MESSAGE_BYTES)"
        )


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
