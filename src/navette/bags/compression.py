"""Unpacking of what bags hold, never into more than was announced."""

import bz2
from typing import Any

import zstandard

from navette.errors import DecodeError

LARGEST = 1 << 30
"""No chunk and no message is unpacked into more bytes than this."""


def unpack(kind: str, data: bytes, size: int) -> bytes:
    """The ``size`` bytes that ``data`` was packed from.

    Raises:
        DecodeError: unknown kind, broken data, or another size.
    """
    if size > LARGEST:
        raise DecodeError(f"{size} bytes in one piece; at most {LARGEST} are read")
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
            raise DecodeError(f"broken {kind} data: {e}") from e
    if len(unpacked) != size:
        raise DecodeError(f"{len(unpacked)} bytes where {size} were announced")
    return unpacked


def is_zstd(data: bytes) -> bool:
    """Whether a message is packed: CDR never begins like that."""
    return data[:4] == b"\x28\xb5\x2f\xfd"


def unpack_zstd_message(data: bytes) -> bytes:
    """A message of a database whose messages are packed one by one."""
    try:
        size = zstandard.frame_content_size(data)
    except zstandard.ZstdError as error:
        raise DecodeError(f"broken zstd data: {error}") from error
    return unpack("zstd", data, size) if size >= 0 else _zstd_of_any_size(data)


def _zstd(data: bytes, size: int) -> bytes:
    announced = zstandard.frame_content_size(data)
    if announced not in (-1, size):
        raise ValueError(f"{announced} bytes inside, {size} announced")
    # One byte more: zero means "as the frame says" to the library.
    unpacked: bytes = zstandard.ZstdDecompressor().decompress(
        data, max_output_size=size + 1
    )
    return unpacked


def _zstd_of_any_size(data: bytes) -> bytes:
    stream = zstandard.ZstdDecompressor().stream_reader(data)
    try:
        unpacked: bytes = stream.read(LARGEST)
    except zstandard.ZstdError as error:
        raise DecodeError(f"broken zstd data: {error}") from error
    return unpacked


def _lz4(data: bytes, size: int) -> bytes:
    import lz4.frame

    decompressor: Any = lz4.frame.LZ4FrameDecompressor()
    unpacked: bytes = decompressor.decompress(data, max_length=size + 1)
    return unpacked


def _bz2(data: bytes, size: int) -> bytes:
    return bz2.BZ2Decompressor().decompress(data, max_length=size + 1)


_KINDS = {"zstd": _zstd, "lz4": _lz4, "bz2": _bz2}
