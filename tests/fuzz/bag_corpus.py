"""Hostile recordings and YAML, XML files that were once a fault, made by a script.

``python tests/fuzz/bag_corpus.py FOLDER`` writes all of them, in the sizes at which the
faults showed; the tests write them with a smaller ``FRACTION``.
"""

import os
import struct
import sys
import zlib
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import lz4.frame
import zstandard
from mcap.writer import CompressionType, Writer

MAGIC = b"\x89MCAP0\r\n"
ESCAPES = "/\x1b]0;owned\x07\x1b[2J\x1b[31m\u202ered\x9b31m\r\n"
BRACKETS = "[" * 60_000
STRING = b"\0\1\0\0\6\0\0\0hello\0"

FRACTION = 1
"""Divisor of the large sizes."""

Make = Callable[[Path], None]
BAGS: dict[str, Make] = {}
"""Name of the file or folder → function that writes it."""
TEXTS: dict[str, str | bytes] = {}
"""File name → content of parameter files, launch files, worlds and manifests."""


def bag(name: str) -> Callable[[Make], Make]:
    """Register a function that writes one recording."""

    def register(make: Make) -> Make:
        BAGS[name] = make
        return make

    return register


def record(opcode: int, content: bytes) -> bytes:
    """Return an MCAP record."""
    return struct.pack("<BQ", opcode, len(content)) + content


def text(value: str | bytes) -> bytes:
    data = value.encode("utf-8", "surrogatepass") if isinstance(value, str) else value
    return struct.pack("<I", len(data)) + data


def header() -> bytes:
    return MAGIC + record(1, text("ros2") + text("corpus"))


def schema(number: int = 1, name: str = "std_msgs/msg/String") -> bytes:
    content = struct.pack("<H", number) + text(name) + text("ros2msg")
    return record(3, content + text(b"string data\n"))


def channel(number: int = 1, topic: str = "/chatter", metadata: bytes = b"") -> bytes:
    content = struct.pack("<HH", number, 1) + text(topic) + text("cdr")
    return record(4, content + text(metadata))


def message(
    stamp: int = 1, *, number: int = 1, sequence: int = 0, data: bytes = STRING
) -> bytes:
    return record(5, struct.pack("<HIQQ", number, sequence, stamp, stamp) + data)


def chunk(
    content: bytes,
    kind: str = "",
    *,
    packed: bytes | None = None,
    size: int | None = None,
    crc: int | None = None,
    times: tuple[int, int] = (1, 1),
) -> bytes:
    """Return a chunk record, with lies where they are given."""
    pack = {"": bytes, "zstd": zstandard.compress, "lz4": lz4.frame.compress}[kind]
    data = pack(content) if packed is None else packed
    head = struct.pack(
        "<QQQI",
        *times,
        len(content) if size is None else size,
        zlib.crc32(content) if crc is None else crc,
    )
    return record(6, head + text(kind) + struct.pack("<Q", len(data)) + data)


END = record(15, bytes(4)) + record(2, bytes(20)) + MAGIC


def write(path: Path, *parts: bytes) -> None:
    path.write_bytes(b"".join((header(), schema(), channel(), *parts, END)))


@bag("qos_brackets.mcap")
def _qos_brackets(path: Path) -> None:
    metadata = text("offered_qos_profiles") + text(BRACKETS)
    path.write_bytes(header() + schema() + channel(metadata=metadata) + message() + END)


@bag("metadata_brackets")
def _metadata_brackets(path: Path) -> None:
    path.mkdir()
    write(path / "a_0.mcap", message())
    (path / "metadata.yaml").write_text(BRACKETS)


@bag("metadata_aliases")
def _metadata_aliases(path: Path) -> None:
    path.mkdir()
    write(path / "a_0.mcap", message())
    (path / "metadata.yaml").write_text(aliases())


@bag("zeros_zstd.mcap")
def _zeros_zstd(path: Path) -> None:
    write(path, message(), chunk(bytes((200 << 20) // FRACTION), "zstd", crc=0))


@bag("zeros_lz4.mcap")
def _zeros_lz4(path: Path) -> None:
    write(path, message(), chunk(bytes((200 << 20) // FRACTION), "lz4", crc=0))


@bag("gigabyte_lz4.mcap")
def _gigabyte_lz4(path: Path) -> None:
    stream, blocks = BytesIO(), 1000 // FRACTION
    with lz4.frame.open(stream, "wb") as packer:
        packer.write(record(5, struct.pack("<HIQQ", 1, 0, 1, 1) + bytes(1 << 20)))
        for _ in range(blocks):
            packer.write(bytes(1 << 20))
    size = 9 + 22 + (1 + blocks) * (1 << 20)
    packed = stream.getvalue()
    write(path, message(), chunk(b"", "lz4", packed=packed, size=size, crc=0))


@bag("bomb_zstd.mcap")
def _bomb_zstd(path: Path) -> None:
    """States 100 bytes and unpacks to a gigabyte."""
    packer = zstandard.ZstdCompressor().compressobj()
    packed = b"".join(packer.compress(bytes(1 << 20)) for _ in range(1024 // FRACTION))
    packed += packer.flush()
    write(path, message(), chunk(b"", "zstd", packed=packed, size=100, crc=0))


@bag("bomb.mcap.zstd")
def _bomb_file(path: Path) -> None:
    """A file compressed as a whole: 64 GiB of zeros in 6 MB."""
    packer = zstandard.ZstdCompressor().compressobj()
    block = bytes(64 << 20)
    with path.open("wb") as file:
        for _ in range(1024 // FRACTION):
            file.write(packer.compress(block))
        file.write(packer.flush())


@bag("many_channels.mcap")
def _many_channels(path: Path) -> None:
    topics = [channel(n, f"/t{n}") for n in range(1, 65_536 // FRACTION)]
    path.write_bytes(header() + schema() + b"".join(topics) + message() + END)


@bag("many_channels_indexed.mcap")
def _many_channels_indexed(path: Path) -> None:
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.NONE)
        writer.start("ros2", "corpus")
        name = "std_msgs/msg/String"
        kind = writer.register_schema(name, "ros2msg", b"string data\n")
        for number in range(65_535 // FRACTION):
            keys = {"n": str(number)}
            key = writer.register_channel(f"/t{number}", "cdr", kind, keys)
            writer.add_message(key, number, STRING, number)
        writer.finish()


@bag("tiny_records.mcap")
def _tiny_records(path: Path) -> None:
    """Half a million records without content, inside and outside of a chunk."""
    tiny = record(0x80, b"")
    inside = chunk(tiny * (300_000 // FRACTION), "zstd")
    write(path, message(), inside, tiny * (200_000 // FRACTION))


@bag("tiny_messages.mcap")
def _tiny_messages(path: Path) -> None:
    write(path, chunk(message(data=b"") * (300_000 // FRACTION), "zstd"))


@bag("escapes.mcap")
def _escapes(path: Path) -> None:
    path.write_bytes(
        header()
        + schema(name=f"std_msgs/msg/{ESCAPES}")
        + channel(topic=ESCAPES)
        + message()
        + END
    )


@bag("long_names.mcap")
def _long_names(path: Path) -> None:
    name = "/" + "a" * (4 << 20)
    parts = schema(name=name), channel(topic=name), message()
    path.write_bytes(header() + b"".join(parts) + END)


@bag("stamps.mcap")
def _stamps(path: Path) -> None:
    write(path, *(message(stamp) for stamp in (2**64 - 1, 0, 2**63, 1, 2**63 - 1)))


@bag("wrong_crc.mcap")
def _wrong_crc(path: Path) -> None:
    write(path, chunk(message(), crc=1), chunk(message(2)))


@bag("lying_times.mcap")
def _lying_times(path: Path) -> None:
    write(path, chunk(message(5), times=(2**63, 0)), chunk(message(7), times=(0, 1)))


@bag("cyclic_index.mcap")
def _cyclic_index(path: Path) -> None:
    """A summary whose chunk indexes all point to the same chunk, and to themselves."""
    start = header() + schema() + channel()
    body = chunk(message())
    data = start + body + record(15, bytes(4))
    summary = schema() + channel()
    for offset in (len(start), len(start), len(data), 0, 2**63):
        summary += record(
            8,
            struct.pack("<QQQQ", 1, 1, offset, len(body))
            + text(b"")
            + struct.pack("<Q", 0)
            + text("")
            + struct.pack("<QQ", 31, 31),
        )
    counts = text(struct.pack("<HQ", 1, 5))
    summary += record(11, struct.pack("<QHIIIIQQ", 5, 1, 1, 0, 0, 5, 1, 1) + counts)
    footer = record(2, struct.pack("<QQI", len(data), 0, 0))
    path.write_bytes(data + summary + footer + MAGIC)


@bag("pipe.mcap")
def _pipe(path: Path) -> None:
    os.mkfifo(path)


@bag("pipe_inside")
def _pipe_inside(path: Path) -> None:
    path.mkdir()
    os.mkfifo(path / "metadata.yaml")
    os.mkfifo(path / "a_0.mcap")


@bag("deep_definition.mcap")
def _deep_definition(path: Path) -> None:
    """A type that contains itself, and one that doubles 60 times."""
    line = "=" * 80 + "\n"
    lines = [f"{line}MSG: corpus/T{n}\nT{n + 1} a\nT{n + 1} b\n" for n in range(60)]
    doubled = "T0 a\n" + "".join(lines) + f"{line}MSG: corpus/T60\nint8 a\n"
    content = struct.pack("<H", 1) + text("corpus/msg/Top") + text("ros2msg")
    itself = struct.pack("<H", 2) + text("corpus/msg/Self") + text("ros2msg")
    second = struct.pack("<HH", 2, 2) + text("/self") + text("cdr") + text(b"")
    path.write_bytes(
        header()
        + record(3, content + text(doubled))
        + record(3, itself + text("Self again\n"))
        + channel()
        + record(4, second)
        + message()
        + message(number=2)
        + END
    )


@bag("service_event.mcap")
def _service_event(path: Path) -> None:
    path.write_bytes(
        header()
        + record(
            3,
            struct.pack("<H", 1)
            + text("corpus_msgs/srv/Do_Event")
            + text("unknown")
            + text(b""),
        )
        + channel(topic="/do/_service_event")
        + message()
        + END
    )


@bag("empty_type.mcap")
def _empty_type(path: Path) -> None:
    kind = struct.pack("<H", 1) + text("test_msgs/msg/Empty") + text("ros2msg")
    path.write_bytes(
        header() + record(3, kind + text(b"")) + channel() + message(data=b"") + END
    )


def aliases(levels: int = 40) -> str:
    """Return YAML whose lists hold the one above them twice: 2^40 items."""
    lines = ["a0: &a0 [x, x]"]
    lines += [f"a{n}: &a{n} [*a{n - 1}, *a{n - 1}]" for n in range(1, levels)]
    return "\n".join(lines)


def merges(levels: int = 40) -> str:
    """Return YAML whose mappings merge the one above them twice."""
    lines = ["a0: &a0 {x: 1}"]
    lines += [f"a{n}: &a{n} {{<<: [*a{n - 1}, *a{n - 1}]}}" for n in range(1, levels)]
    return "\n".join(lines)


_NESTED = "".join(f"{' ' * n}a:\n" for n in range(3000))
TEXTS |= {
    "brackets.yaml": BRACKETS,
    "braces.yaml": "{a: " * 60_000,
    "dashes.yaml": "- " * 60_000,
    "questions.yaml": "? " * 60_000,
    "nested.yaml": _NESTED,
    "aliases.yaml": aliases(),
    "merges.yaml": merges(),
    "cycle.yaml": "a: &a [*a]\nb: &b {b: *b}",
    "long_number.yaml": f"a: {'1' * 100_000}\n",
    "sexagesimal.yaml": f"a: 1{':1' * (200_000 // FRACTION)}\n",
    "bad_date.yaml": "a: 2001-99-99\n",
    "object.yaml": "a: !!python/object/apply:os.system [true]\n",
    "many.yaml": "- a\n" * 110_000,
    "nul.yaml": "a: \0\n",
    "escapes.yaml": 'a: "\\e[31m"\n' + ESCAPES,
    "not_utf8.yaml": b"\xff\xfe\xff",
    "deep.xml": "<a>" * 60_000,
    "wide.xml": "<a>" + "<b/>" * 110_000 + "</a>",
    "attributes.xml": "<a " + " ".join(f"b{n}=''" for n in range(110_000)) + "/>",
    "entities.xml": '<!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>',
    "lines.xml": "<a>" + "\n" * 1_000_000 + "</a>",
    "encoding.xml": '<?xml version="1.0" encoding="no-such"?><a/>',
    "not_xml.xml": b"\0" * 1000,
}


def make(folder: Path, names: list[str] | None = None) -> dict[str, Path]:
    """Write the corpus (or the named files of it) and return the paths by name."""
    folder.mkdir(parents=True, exist_ok=True)
    paths: dict[str, Path] = {}
    entries: dict[str, Any] = {**BAGS, **TEXTS}
    for name in names or entries:
        path = paths[name] = folder / name
        entry = entries[name]
        if callable(entry):
            entry(path)
        elif isinstance(entry, bytes):
            path.write_bytes(entry)
        else:
            path.write_text(entry, "utf-8")
    return paths


if __name__ == "__main__":
    for made in make(Path(sys.argv[1])).values():
        sys.stdout.write(f"{made}\n")
