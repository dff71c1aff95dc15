"""The files of the official MCAP conformance set, made from their names.

A name such as ``OneMessage-ch-chx-st`` lists the features of the file: chunks (``ch``),
chunk index (``chx``), message index (``mx``), statistics (``st``), repeated schemas
(``rsh``) and channels (``rch``), attachment (``ax``) and metadata index (``mdx``),
summary offsets (``sum``), extra bytes at the end of records (``pad``). The bytes are
those of the set: ``tests/conformance/mcap_set.py`` compares checksums where a folder
has only pointers.
"""

import struct
import zlib
from itertools import combinations

MAGIC = b"\x89MCAP0\r\n"
_FEATURES = ("ax", "ch", "chx", "mdx", "mx", "pad", "rch", "rsh", "st", "sum")
_TIMES = (0, 2, 1, 3, 3, 5, 4, 7, 8, 9)


def text(value: str | bytes) -> bytes:
    data = value.encode() if isinstance(value, str) else value
    return struct.pack("<I", len(data)) + data


def pairs(values: dict[str, str]) -> bytes:
    return text(b"".join(text(key) + text(value) for key, value in values.items()))


_SCHEMA = struct.pack("<H", 1) + text("Example") + text("c") + text(b"\4\5\6")
_CHANNEL = (
    struct.pack("<HH", 1, 1) + text("example") + text("a") + pairs({"foo": "bar"})
)
_BARE_CHANNEL = struct.pack("<HH", 1, 0) + text("example") + text("text") + pairs({})


def _message(sequence: int, log: int, published: int) -> bytes:
    return struct.pack("<HIQQ", 1, sequence, log, published) + b"\1\2\3"


_ONE = (5, _message(10, 2, 1))
_TEN = [(5, _message(n, stamp, stamp)) for n, stamp in enumerate(_TIMES)]
_ATTACHMENT = (
    struct.pack("<QQ", 2, 1)
    + text("myFile")
    + text("application/octet-stream")
    + struct.pack("<Q", 3)
    + b"\1\2\3"
)
_METADATA = text("myMetadata") + pairs({"foo": "bar"})
INPUTS: dict[str, list[tuple[int, bytes]]] = {
    "NoData": [],
    "OneSchemalessMessage": [(4, _BARE_CHANNEL), _ONE],
    "OneMessage": [(3, _SCHEMA), (4, _CHANNEL), _ONE],
    "OneAttachment": [(9, _ATTACHMENT)],
    "OneMetadata": [(12, _METADATA)],
    "TenMessages": [(3, _SCHEMA), (4, _CHANNEL), *_TEN],
}


def names() -> list[str]:
    """Return the names of all variants."""
    found = []
    for base, records in INPUTS.items():
        kinds = {opcode for opcode, _ in records}
        for count in range(len(_FEATURES) + 1):
            for chosen in combinations(_FEATURES, count):
                if _makes_sense(set(chosen), kinds):
                    found.append("-".join((base, *chosen)))
    return found


def _makes_sense(features: set[str], kinds: set[int]) -> bool:
    required = {"ax": 9, "mdx": 12, "rsh": 3, "rch": 4}
    if any(name in features and kind not in kinds for name, kind in required.items()):
        return False
    if features & {"ch", "chx", "mx"} and not kinds & {3, 4, 5}:
        return False
    if features & {"chx", "mx"} and "ch" not in features:
        return False
    indexes = {"chx", "rsh", "rch", "mdx", "ax", "st"}
    return "sum" not in features or bool(features & indexes)


def variant(name: str) -> bytes:
    """Return the bytes of a file of the set."""
    base, *features = name.split("-")
    return _Variant(INPUTS[base], set(features)).data


class _Variant:
    def __init__(self, records: list[tuple[int, bytes]], features: set[str]) -> None:
        self._features = features
        self._pad = b"\1\xff\xff" if "pad" in features else b""
        self.data = MAGIC + self._padded(1, text("") + text(""))
        indexes: dict[int, bytes] = {}
        in_chunk = b""
        for opcode, content in records:
            if "ch" in features and opcode in (3, 4, 5):
                in_chunk += _record(opcode, content)
            else:
                indexes |= self._add(opcode, content)
        if "ch" in features:
            indexes |= self._add_chunk(records, in_chunk)
        self.data += _record(15, struct.pack("<I", zlib.crc32(self.data)))
        self._summary(records, indexes)

    def _padded(self, opcode: int, content: bytes) -> bytes:
        return _record(opcode, content + self._pad)

    def _add(self, opcode: int, content: bytes) -> dict[int, bytes]:
        """Append a record; return its index, by opcode, if the file has one."""
        offset = len(self.data)
        if opcode == 9:
            content += struct.pack("<I", zlib.crc32(content))
        is_message = opcode == 5
        record = _record(5, content) if is_message else self._padded(opcode, content)
        self.data += record
        place = struct.pack("<QQ", offset, len(record))
        if opcode == 9 and "ax" in self._features:
            names = text("myFile") + text("application/octet-stream")
            return {10: place + struct.pack("<QQQ", 2, 1, 3) + names}
        if opcode == 12 and "mdx" in self._features:
            return {13: place + text("myMetadata")}
        return {}

    def _add_chunk(
        self, records: list[tuple[int, bytes]], content: bytes
    ) -> dict[int, bytes]:
        stamps, entries = _stamps(records), b""
        position = 0
        listed = []
        for opcode, each in records:
            if opcode == 5:
                listed.append((_log_time(each), position))
            position += 9 + len(each)
        for stamp, offset in listed:
            entries += struct.pack("<QQ", stamp, offset)
        start = len(self.data)
        head = struct.pack("<QQQI", *stamps, len(content), zlib.crc32(content)) + text(
            ""
        )
        chunk = _record(6, head + struct.pack("<Q", len(content)) + content)
        self.data += chunk
        offsets, length = b"", 0
        if "mx" in self._features and listed:
            offsets = struct.pack("<HQ", 1, len(self.data))
            index = self._padded(7, struct.pack("<H", 1) + text(entries))
            length = len(index)
            self.data += index
        if "chx" not in self._features:
            return {}
        return {
            8: struct.pack("<QQQQ", *stamps, start, len(chunk))
            + text(offsets)
            + struct.pack("<Q", length)
            + text("")
            + struct.pack("<QQ", len(content), len(content))
        }

    def _summary(
        self, records: list[tuple[int, bytes]], indexes: dict[int, bytes]
    ) -> None:
        start = len(self.data)
        offsets = b""
        groups: list[tuple[int, bytes]] = []
        if "rsh" in self._features:
            groups += [(3, content) for opcode, content in records if opcode == 3]
        if "rch" in self._features:
            groups += [(4, content) for opcode, content in records if opcode == 4]
        if "st" in self._features:
            groups.append((11, self._statistics(records)))
        groups += [(kind, indexes[kind]) for kind in (13, 10, 8) if kind in indexes]
        for opcode, content in groups:
            record = self._padded(opcode, content)
            place = struct.pack("<BQQ", opcode, len(self.data), len(record))
            offsets += self._padded(14, place)
            self.data += record
        offset_start = len(self.data) if "sum" in self._features else 0
        if "sum" in self._features:
            self.data += offsets
        summary = struct.pack("<QQ", start if groups else 0, offset_start)
        head = struct.pack("<BQ", 2, 20) + summary
        crc = zlib.crc32(head, zlib.crc32(self.data[start:]))
        self.data += head + struct.pack("<I", crc) + MAGIC

    def _statistics(self, records: list[tuple[int, bytes]]) -> bytes:
        kinds = [opcode for opcode, _ in records]
        count = kinds.count(5)
        return struct.pack(
            "<QHIIIIQQ",
            *(count, kinds.count(3), kinds.count(4), kinds.count(9), kinds.count(12)),
            *("ch" in self._features, *_stamps(records)),
        ) + text(struct.pack("<HQ", 1, count) if count else b"")


def _record(opcode: int, content: bytes) -> bytes:
    return struct.pack("<BQ", opcode, len(content)) + content


def _log_time(message: bytes) -> int:
    return int.from_bytes(message[6:14], "little")


def _stamps(records: list[tuple[int, bytes]]) -> tuple[int, int]:
    found = [_log_time(content) for opcode, content in records if opcode == 5]
    return min(found, default=0), max(found, default=0)
