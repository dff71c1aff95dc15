"""CDR encoding of strings of 16-bit units, and of lists of bools and bytes."""

import struct
from collections.abc import Callable
from typing import Any

import numpy as np

from navette.errors import DecodeError

WIDE_UNIT = 4  # bytes that a UTF-16 unit of a wstring takes
_BOOLS = b"\x00\x01"


def pack_bools(items: list[bool]) -> bytes:
    """Encode each bool as one octet.

    Raises:
        TypeError: an element is not a bool; the list was changed in place.
    """
    try:
        packed = bytes(items)
    except ValueError as error:
        raise TypeError(str(error)) from None
    if packed.translate(None, _BOOLS):
        raise TypeError("an element is not a bool")
    return packed


def pack_bytes(items: list[bytes]) -> bytes:
    """Concatenate single bytes.

    Raises:
        TypeError: an element is not a single byte; the list was changed in place.
    """
    packed = b"".join(items)
    if len(packed) != len(items):
        raise TypeError("an element is not a single byte")
    return packed


def unpack_bools(field: str, data: bytes | memoryview) -> list[bool]:
    """Decode octets; raises DecodeError for one that is neither 0 nor 1."""
    wrong = bytes(data).translate(None, _BOOLS)
    if wrong:
        raise DecodeError(f"{field}: {wrong[0]} is not a bool (0 or 1)")
    return list(map(bool, data))


def unpack_bytes(field: str, data: bytes | memoryview) -> list[bytes]:
    """Split octets into ``bytes`` of length one."""
    return list(struct.unpack(f"{len(data)}c", data))


PACK: dict[str, Callable[[Any], bytes]] = {"bool": pack_bools, "byte": pack_bytes}
UNPACK: dict[str, Callable[[str, bytes | memoryview], list[Any]]] = {
    "bool": unpack_bools,
    "byte": unpack_bytes,
}


def encode_wide(text: str) -> bytes:
    """Encode a wstring, little-endian, without its length.

    As rosidl_typesupport_fastrtps: UTF-16 units, each as a uint32, no terminator; the
    length in front of them counts units.
    """
    units = np.frombuffer(text.encode("utf-16-le"), "<u2")
    return units.astype("<u4").tobytes()


def decode_wide(data: bytes | memoryview, order: str) -> str:
    """Decode the units of a wstring in byte order ``<`` or ``>``.

    Raises:
        ValueError: a unit of more than 16 bits, or half a surrogate pair.
    """
    units = np.frombuffer(data, f"{order}u4")
    if units.size and units.max() > 0xFFFF:
        raise ValueError(f"wstring unit {units.max()} does not fit 16 bits")
    return units.astype("<u2").tobytes().decode("utf-16-le")
