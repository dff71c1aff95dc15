"""wstring on the wire: UTF-16 units, each in four bytes.

So does rosidl_typesupport_fastrtps: a uint32 count of units, no terminator, then one
uint32 a unit.
"""

import numpy as np

WIDE_UNIT = 4  # bytes


def encode_wide(text: str) -> bytes:
    """The units of ``text``, little-endian."""
    units = np.frombuffer(text.encode("utf-16-le"), "<u2")
    return units.astype("<u4").tobytes()


def decode_wide(data: bytes | memoryview, order: str) -> str:
    """The text of units in byte order ``<`` or ``>``.

    Raises:
        ValueError: a unit over 16 bits, or half a pair.
    """
    units = np.frombuffer(data, f"{order}u4")
    if units.size and units.max() > 0xFFFF:
        raise ValueError(f"wstring unit {units.max()} does not fit 16 bits")
    return units.astype("<u2").tobytes().decode("utf-16-le")
