"""Decompression of chunks and messages, bounded by the stated size."""

import bz2
from io import BytesIO
from typing import Any

import zstandard

from navette.errors import DecodeError

_BLOCK = 8 << 20
LARGEST = 1 << 29
"""Maximum uncompressed size of a chunk or message, bytes."""


def unpack(kind: str, data: bytes, size: int) -> bytes:
    """Decompress ``data`` to exactly ``size`` bytes.

    Raises:
        DecodeError: unknown kind, damaged data, or another size.
    """
    if size > LARGEST:
        raise DecodeError(f"{size} uncompressed bytes; at most {LARGEST} are allowed")
    if kind in ("", "none"):
        unpacked = data
    else:
        try:
            unpack_kind = _KINDS[kind]
        except KeyError:
            known = ", ".join(sorted(_KINDS))
            raise DecodeError(f"compression {kind!r}; known: none, {known}") from None
        try:
            unpacked = unpack_kind(data, size)
        except (zstandard.ZstdError, OSError, EOFError, RuntimeError, ValueError) as e:
            raise DecodeError(f"damaged {kind} data: {e}") from e
    if len(unpacked) != size:
        raise DecodeError(f"{len(unpacked)} bytes, but {size} were stated")
    return unpacked


def is_zstd(data: bytes) -> bool:
    """Whether a message is compressed: CDR never begins with these bytes."""
    return data[:4] == b"\x28\xb5\x2f\xfd"


def unpack_zstd_message(data: bytes) -> bytes:
    """Decompress a message of a database with per-message compression."""
    try:
        size = zstandard.frame_content_size(data)
    except zstandard.ZstdError as error:
        raise DecodeError(f"damaged zstd data: {error}") from error
    return unpack("zstd", data, size) if size >= 0 else _zstd_of_any_size(data)


def _zstd(data: bytes, size: int) -> bytes:
    announced = zstandard.frame_content_size(data)
    if announced not in (-1, size):
        raise ValueError(f"{announced} bytes in the frame, but {size} were stated")
    # One byte more: for the library, zero means the size in the frame.
    unpacked: bytes = zstandard.ZstdDecompressor().decompress(
        data, max_output_size=size + 1
    )
    return unpacked


def _zstd_of_any_size(data: bytes) -> bytes:
    stream = zstandard.ZstdDecompressor().stream_reader(data)
    try:
        unpacked: bytes = stream.read(LARGEST)
    except zstandard.ZstdError as error:
        raise DecodeError(f"damaged zstd data: {error}") from error
    return unpacked


def _lz4(data: bytes, size: int) -> bytes:
    import lz4.frame

    return _in_blocks(lz4.frame.LZ4FrameDecompressor(), data, size)


def _bz2(data: bytes, size: int) -> bytes:
    return _in_blocks(bz2.BZ2Decompressor(), data, size)


def _in_blocks(decompressor: Any, data: bytes, size: int) -> bytes:
    """Decompress at most one byte more than stated; memory grows with the output."""
    found = BytesIO()
    while found.tell() <= size and not decompressor.eof:
        block = decompressor.decompress(
            data, max_length=min(_BLOCK, size + 1 - found.tell())
        )
        if not block and decompressor.needs_input:
            break
        found.write(block)
        data = b""
    return found.getvalue()


_KINDS = {"zstd": _zstd, "lz4": _lz4, "bz2": _bz2}
