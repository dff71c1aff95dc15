"""Lists of bools and of bytes on the wire: an octet an element."""

import struct
from collections.abc import Callable
from typing import Any

from navette.errors import DecodeError

_BOOLS = b"\x00\x01"


def pack_bools(items: list[bool]) -> bytes:
    """An octet for each.

    Raises:
        TypeError: the list was changed in place to hold something else.
    """
    try:
        packed = bytes(items)
    except ValueError as error:
        raise TypeError(str(error)) from None
    if packed.translate(None, _BOOLS):
        raise TypeError("not all are bools")
    return packed


def pack_bytes(items: list[bytes]) -> bytes:
    """Single bytes, put together; raises as :func:`pack_bools`."""
    packed = b"".join(items)
    if len(packed) != len(items):
        raise TypeError("not all are single bytes")
    return packed


def unpack_bools(field: str, data: bytes | memoryview) -> list[bool]:
    """Raises DecodeError where an octet is neither 0 nor 1."""
    wrong = bytes(data).translate(None, _BOOLS)
    if wrong:
        raise DecodeError(f"{field}: {wrong[0]} is no bool")
    return list(map(bool, data))


def unpack_bytes(field: str, data: bytes | memoryview) -> list[bytes]:
    """Each octet as bytes of length one."""
    return list(struct.unpack(f"{len(data)}c", data))


PACK: dict[str, Callable[[Any], bytes]] = {"bool": pack_bools, "byte": pack_bytes}
UNPACK: dict[str, Callable[[str, bytes | memoryview], list[Any]]] = {
    "bool": unpack_bools,
    "byte": unpack_bytes,
}
