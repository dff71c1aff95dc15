"""All formats through one interface: order, time ranges, topics, types, memory."""

import sqlite3
import tracemalloc
from pathlib import Path
from typing import Any

import pytest
import zstandard
from mcap.writer import CompressionType, IndexType, Writer
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Ros2Writer
from rosbags.rosbag2.enums import CompressionFormat, CompressionMode
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from bag_samples import (
    CHATTER,
    POINT,
    START_NS,
    STEP_NS,
    sample,
    write_sample,
)
from navette.bags import BagMessage, BagWriter, open_bag, parse_qos, qos_text
from navette.bags.chunks import Chunk, ChunkMerge, ChunkQuery, Entry
from navette.bags.message_types import Decoder
from navette.bags.play import PrefetchingFeed
from navette.bags.summary import summarise
from navette.bags.writing import open_writer
from navette.errors import FileFormatError
from navette.msgs import definition_text, serialize, type_name
from navette.msgs.std_msgs.msg import String

FORMATS = ("mcap", "bag", "db3")


def fields_of(messages: list[BagMessage]) -> list[tuple[str, str, int, bytes]]:
    return [(m.topic.name, m.topic.type_name, m.stamp_ns, m.data) for m in messages]


@pytest.mark.parametrize("suffix", FORMATS)
def test_written_messages_are_read(tmp_path: Path, suffix: str) -> None:
    path = write_sample(tmp_path / f"a.{suffix}", 101)
    with open_bag(path) as reader:
        assert fields_of(list(reader.messages())) == fields_of(sample(101))
        assert (reader.start_ns, reader.end_ns) == (START_NS, START_NS + 100 * STEP_NS)
        counts = {topic.name: count for topic, count in reader.counts().items()}
        assert counts == {"/chatter": 51, "/point": 50}
        assert len(list(reader.stamps())) == 101
        assert reader.problems == ()
        assert {topic.name: topic.latched for topic in reader.topics} == {
            "/chatter": True,
            "/point": False,
        }
        assert all(t.definition == definition_text(t.type_name) for t in reader.topics)


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_thread_of_a_player_reads_ahead(tmp_path: Path, suffix: str) -> None:
    with open_bag(write_sample(tmp_path / f"a.{suffix}", 101)) as reader:
        feed = PrefetchingFeed(reader.messages())
        read = list(iter(feed.pop, None))
        feed.close()
    assert fields_of(read) == fields_of(sample(101))


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_recording_is_found_without_its_suffix(tmp_path: Path, suffix: str) -> None:
    path = write_sample(tmp_path / f"subset.{suffix}", 3)
    with open_bag(tmp_path / "subset") as reader:
        assert reader.path == path
    with pytest.raises(FileFormatError, match="subse: cannot be opened"):
        open_bag(tmp_path / "subse")


@pytest.mark.parametrize("suffix", FORMATS)
def test_time_ranges_and_topics(tmp_path: Path, suffix: str) -> None:
    with open_bag(write_sample(tmp_path / f"a.{suffix}", 50)) as reader:
        first, last = START_NS + 10 * STEP_NS, START_NS + 20 * STEP_NS
        part = list(reader.messages(start_ns=first, end_ns=last))
        assert fields_of(part) == fields_of(sample(50)[10:21])
        points = list(reader.messages(["/point"], start_ns=first + 1))
        assert fields_of(points) == fields_of(
            [m for m in sample(50)[11:] if m.topic == POINT]
        )
        assert list(reader.messages(["/absent"])) == []
        assert list(reader.messages(start_ns=last, end_ns=first)) == []
        # Two readings of one open file do not disturb each other.
        one, other = reader.messages(), reader.messages(start_ns=last)
        assert next(one).stamp_ns == START_NS
        assert next(other).stamp_ns == last
        assert next(one).stamp_ns == START_NS + STEP_NS


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_recording_without_messages(tmp_path: Path, suffix: str) -> None:
    with open_bag(write_sample(tmp_path / f"a.{suffix}", 0)) as reader:
        assert list(reader.messages()) == []
        assert (reader.start_ns, reader.end_ns) == (0, 0)
        assert summarise(reader).messages == 0


@pytest.mark.parametrize("compression", list(CompressionType))
@pytest.mark.parametrize("chunked", [True, False])
@pytest.mark.parametrize("indexed", [True, False])
def test_mcap_of_another_writer(
    tmp_path: Path, compression: CompressionType, chunked: bool, indexed: bool
) -> None:
    """With and without chunks, indexes and summary; some stamps decrease."""
    path = tmp_path / "a.mcap"
    with path.open("wb") as file:
        writer = Writer(
            file,
            chunk_size=300,
            compression=compression,
            use_chunking=chunked,
            index_types=IndexType.ALL if indexed else IndexType.NONE,
            use_summary_offsets=indexed,
            use_statistics=indexed,
            repeat_channels=indexed,
            repeat_schemas=indexed,
        )
        writer.start("ros2", "test")
        schema = writer.register_schema(
            "std_msgs/msg/String", "ros2msg", b"string data"
        )
        channel = writer.register_channel("/chatter", "cdr", schema)
        stamps = [n * 10 - (35 if n % 7 == 0 else 0) for n in range(10, 60)]
        for stamp in stamps:
            data = serialize(String(data=str(stamp)))
            writer.add_message(channel, stamp, data, stamp)
        writer.finish()
    with open_bag(path) as reader:
        found = list(reader.messages())
        assert [m.stamp_ns for m in found] == sorted(stamps)
        decode = Decoder(reader.topics[0])
        assert [decode(m.data).data for m in found] == [str(n) for n in sorted(stamps)]
        assert list(reader.counts().values()) == [50]
        part = list(reader.messages(start_ns=200, end_ns=300))
        assert [m.stamp_ns for m in part] == [
            n for n in sorted(stamps) if 200 <= n <= 300
        ]


ROS1_MARKER = """Header header
string ns
float64[9] K
duration lifetime
"""


@pytest.mark.parametrize("compression", ["none", "bz2", "lz4"])
@pytest.mark.parametrize("indexed", [True, False])
def test_ros1_of_another_writer(
    tmp_path: Path, compression: str, indexed: bool
) -> None:
    path = tmp_path / "a.bag"
    store = get_typestore(Stores.ROS1_NOETIC)
    store.register(get_types_from_msg(ROS1_MARKER, "reading_cases/msg/marker"))
    writer = Ros1Writer(path)
    if compression != "none":
        writer.set_compression(writer.CompressionFormat[compression.upper()])
    writer.chunk_threshold = 500
    kind: Any = store.types["reading_cases/msg/marker"]
    header: Any = store.types["std_msgs/msg/Header"]
    moment: Any = store.types["builtin_interfaces/msg/Time"]
    with writer:
        name = "reading_cases/msg/marker"
        channel = writer.add_connection("/mark//s/", name, typestore=store, latching=1)
        for number in range(20):
            message = kind(
                header(number, moment(number, 5), "map"),
                f"n{number}",
                get_numbers(number),
                store.types["builtin_interfaces/msg/Duration"](-1, 7),
            )
            writer.write(channel, number * 10**9, store.serialize_ros1(message, name))
    if not indexed:  # as a killed recording is
        with path.open("r+b") as file:
            whole = file.read()
            position = whole.index(b"index_pos=") + len(b"index_pos=")
            end = int.from_bytes(whole[position : position + 8], "little")
            file.seek(position)
            file.write(bytes(8))
            file.truncate(end)
    with open_bag(path) as reader:
        (topic,) = reader.topics
        assert (topic.name, topic.type_name) == (
            "/mark/s",
            "reading_cases/msg/Marker",
        )
        assert topic.latched
        assert bool(reader.problems) is not indexed
        decode = Decoder(topic)
        messages = [decode(m.data) for m in reader.messages()]
    assert [m.ns for m in messages] == [f"n{n}" for n in range(20)]
    assert messages[3].header.stamp.sec == 3
    assert messages[3].header.frame_id == "map"
    assert messages[3].k.tolist() == [3.0] * 9
    assert (messages[3].lifetime.sec, messages[3].lifetime.nanosec) == (-1, 7)


def get_numbers(number: int) -> Any:
    import numpy as np

    return np.full(9, number, np.float64)


@pytest.mark.parametrize("plugin", list(StoragePlugin))
@pytest.mark.parametrize("mode", ["NONE", "MESSAGE", "FILE"])
def test_folders_of_rosbag2(tmp_path: Path, plugin: Any, mode: str) -> None:
    folder = tmp_path / "run"
    store = get_typestore(Stores.ROS2_JAZZY)
    writer = Ros2Writer(folder, version=9, storage_plugin=plugin)
    writer.set_compression(CompressionMode[mode], CompressionFormat.ZSTD)
    with writer:
        channel = writer.add_connection("/a", "std_msgs/msg/String", typestore=store)
        for number in range(10):
            writer.write(channel, number + 5, serialize(String(data=f"{number}")))
    with open_bag(folder) as reader:
        decode = Decoder(reader.topics[0])
        assert [decode(m.data).data for m in reader.messages()] == list("0123456789")
        assert (reader.start_ns, reader.end_ns) == (5, 14)
        assert list(reader.counts().values()) == [10]
        assert reader.topics[0].type_hash.startswith("RIHS01_")
    (folder / "metadata.yaml").write_text("{[", "utf-8")
    with open_bag(folder) as reader:
        assert "metadata.yaml:2: is not YAML" in reader.problems[0]
        assert len(list(reader.messages())) == 10
    # A single compressed file, without its folder.
    (file,) = [each for each in folder.iterdir() if each.name != "metadata.yaml"]
    with open_bag(file) as reader:
        assert len(list(reader.messages())) == 10


def test_an_old_database_without_definitions_and_index(tmp_path: Path) -> None:
    path = tmp_path / "old.db3"
    database = sqlite3.connect(path)
    database.executescript(
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL,"
        " type TEXT NOT NULL, serialization_format TEXT NOT NULL);"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,"
        " timestamp INTEGER NOT NULL, data BLOB NOT NULL);"
        "INSERT INTO topics VALUES(7, '/a', 'std_msgs/msg/String', 'cdr');"
    )
    for number in (3, 1, 2):
        row = (7, number, serialize(String(data=f"{number}")))
        query = "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)"
        database.execute(query, row)
    database.commit()
    database.close()
    with open_bag(path) as reader:
        assert reader.version == "1"
        assert [m.stamp_ns for m in reader.messages()] == [1, 2, 3]
        decode = Decoder(reader.topics[0])
        assert [decode(m.data).data for m in reader.messages()] == ["1", "2", "3"]


def test_types_that_are_not_installed_or_of_another_release(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    writer = BagWriter(path)
    for name, text in (
        ("reading_unknown/msg/Beep", "int32 volume\n"),
        ("geometry_msgs/msg/Point32", "float32 x\nfloat32 y\n"),
    ):
        writer.write(writer.add_channel(f"/{name}", name, text), 1, bytes(4) + bytes(8))
    writer.close()
    with open_bag(path) as reader:
        summary = summarise(reader)
        assert [each.known for each in summary.topics] == [False, False]
        classes = {t.type_name: Decoder(t).message_class for t in reader.topics}
    beep = classes["reading_unknown/msg/Beep"]
    assert type_name(beep) == "reading_unknown/msg/Beep"
    old = classes["geometry_msgs/msg/Point32"]
    assert type_name(old).startswith("geometry_msgs__")
    assert list(old.get_fields_and_field_types()) == ["x", "y"]


def test_gaps_and_rates(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    writer = BagWriter(path)
    channel = writer.add_channel("/a", CHATTER.type_name, CHATTER.definition)
    for stamp in (*range(0, 100, 10), *range(500, 600, 10)):
        writer.write(channel, stamp * 10**8, b"\0\1\0\0\1\0\0\0\0")
    writer.close()
    with open_bag(path) as reader:
        (topic,) = summarise(reader).topics
    assert topic.rate_hz == pytest.approx(1.0)
    assert topic.mean_rate_hz == pytest.approx(19 / 59)
    assert topic.longest_gap_s == pytest.approx(41.0)
    assert topic.gap_start_s == pytest.approx(9.0)


@pytest.mark.parametrize("text", ["", "-", "[", "a: b", "- 3", "- depth: x", "&a [*a]"])
def test_invalid_qos_is_ignored(text: str) -> None:
    assert len(parse_qos(text)) <= 1


def test_qos_in_numbers_and_words() -> None:
    numbers = "- history: 1\n  depth: 3\n  reliability: 2\n  durability: 1\n"
    (offer,) = parse_qos(numbers)
    assert (offer.history, offer.depth) == ("keep_last", 3)
    assert (offer.reliability, offer.durability) == ("best_effort", "transient_local")
    assert parse_qos(qos_text([offer])) == (offer,)


# -- what is in memory -----------------------------------------------------------


def test_overlapping_chunks_do_not_all_stay_in_memory() -> None:
    """Each chunk has one message at the first stamp and one at the last."""
    chunks = [Chunk(n, n, 1, 0, 1000 + n) for n in range(50)]

    class File:
        def read_chunk(self, chunk: Chunk) -> bytes:
            return bytes([chunk.number]) * 1000

        def parse_chunk(self, chunk: Chunk, data: bytes) -> list[Entry]:
            return [Entry(0, 1, 0, 1), Entry(1000 + chunk.number, 1, 1, 2)]

    merge = ChunkMerge(File(), cache_bytes=5000)
    found = list(merge.messages(chunks, ChunkQuery(None, 0, 10**6)))
    assert [entry.stamp_ns for entry, _ in found] == [0] * 50 + list(range(1000, 1050))
    assert [data[0] for _, data in found] == [*range(50), *range(50)]
    assert len(merge.cached) <= 5


@pytest.mark.slow
@pytest.mark.parametrize("suffix", ["mcap", "bag"])
def test_memory_stays_flat(tmp_path: Path, suffix: str) -> None:
    """A hundred chunks are read with the memory of a few."""
    path = tmp_path / f"a.{suffix}"
    writer = open_writer(path, compression="none")
    data = serialize(String(data="x" * 60_000))
    for number in range(800):
        writer.write(BagMessage(CHATTER, number, data))
    writer.close()
    assert path.stat().st_size > 40_000_000
    with open_bag(path) as reader:
        tracemalloc.start()
        count = sum(1 for _ in reader.messages())
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert count == 800
    assert peak < 8_000_000


def test_zstd_bombs_are_refused(tmp_path: Path) -> None:
    from navette.bags.compression import unpack, unpack_zstd_message
    from navette.errors import DecodeError

    bomb = zstandard.ZstdCompressor().compress(bytes(50_000_000))
    with pytest.raises(DecodeError, match="were stated"):
        unpack("zstd", bomb, 100)
    with pytest.raises(DecodeError, match="at most"):
        unpack("zstd", bomb, 1 << 40)
    with pytest.raises(DecodeError, match="compression 'rar'"):
        unpack("rar", bomb, 100)
    stream = zstandard.ZstdCompressor(write_content_size=False).compress(b"abc" * 100)
    assert unpack_zstd_message(stream) == b"abc" * 100


def test_a_message_of_an_undefined_topic(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.NONE)
        writer.start("ros2", "test")
        writer.add_message(9, 1, b"x", 1)
        writer.finish()
    lost: list[Any] = []
    with open_bag(path) as reader:
        assert list(reader.messages(on_damage=lost.append)) == []
        with pytest.raises(FileFormatError, match="undefined channel 9"):
            list(reader.messages())
    assert len(lost) == 1


def test_other_encodings_are_distinguished(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start("", "test")
        schema = writer.register_schema("Beep", "jsonschema", b"{}")
        writer.add_message(writer.register_channel("/a", "json", schema), 1, b"{}", 1)
        writer.finish()
    with open_bag(path) as reader:
        (topic,) = reader.topics
        assert (topic.name, topic.type_name, topic.encoding) == ("/a", "Beep", "json")
        assert topic.channel is not None
        assert (topic.channel.schema_encoding, topic.channel.schema) == (
            "jsonschema",
            b"{}",
        )
        assert next(reader.messages()).data == b"{}"
        with pytest.raises(FileFormatError, match="json messages are not ROS messages"):
            Decoder(reader.topics[0])


IDL = """
module reading_idl {
  module msg {
    module Scene_Constants {
      const int32 LARGE = 3;
    };
    struct Scene {
      geometry_msgs::msg::Point corner;
      sequence<float> heights;
      double grid[4];
      string name;
    };
  };
};
"""
POINT_IDL = """
module geometry_msgs { module msg {
  struct Point { double x; double y; double z; };
}; };
"""


def test_definitions_in_idl(tmp_path: Path) -> None:
    line = "=" * 80
    text = f"{line}\nIDL: reading_idl/msg/Scene\n{IDL}"
    text += f"{line}\nIDL: geometry_msgs/msg/Point\n{POINT_IDL}"
    path = tmp_path / "a.mcap"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start("ros2", "test")
        for name, definition in (
            ("reading_idl/msg/Scene", text),
            ("reading_idl/msg/Broken", "module {"),
        ):
            schema = writer.register_schema(name, "ros2idl", definition.encode())
            channel = writer.register_channel(f"/{name}", "cdr", schema)
            writer.add_message(channel, 1, bytes(4), 1)
        writer.finish()
    with open_bag(path) as reader:
        broken, scene = sorted(reader.topics, key=lambda topic: topic.name)
        assert broken.definition == ""
        assert "/reading_idl/msg/Broken" in reader.remarks[0]
        assert reader.problems == ()
        assert len(list(reader.messages())) == 2
    kind: Any = Decoder(scene).message_class
    assert kind.LARGE == 3
    assert list(kind.get_fields_and_field_types()) == [
        "corner",
        "heights",
        "grid",
        "name",
    ]
    assert len(kind().grid) == 4


# Each list holds the one before nine times: 9 to the power of 11 when printed.
BOMB = "  x0: &x0 [1]\n" + "".join(
    f"  x{n}: &x{n} [{', '.join([f'*x{n - 1}'] * 9)}]\n" for n in range(1, 12)
)
INFORMATION = "rosbag2_bagfile_information:"


@pytest.mark.parametrize(
    "text",
    [
        "",
        "3",
        f"{INFORMATION} 3",
        f"{INFORMATION} {{version: 8}}",
        f"{INFORMATION}\n{BOMB}  version: *x11\n  relative_file_paths: []",
        f"{INFORMATION} {{version: 8, relative_file_paths: [[a]]}}",
        f"{INFORMATION} {{version: 8, relative_file_paths: [../a.mcap]}}",
    ],
)
def test_invalid_metadata(tmp_path: Path, text: str) -> None:
    """The bag file beside them is read; no file outside the folder is."""
    write_sample(tmp_path / "b.mcap")
    (tmp_path / "metadata.yaml").write_text(text, "utf-8")
    try:
        with open_bag(tmp_path) as reader:
            assert "metadata.yaml" in reader.problems[0]
            assert len(list(reader.messages())) == 6
    except FileFormatError as error:
        assert "a.mcap: cannot be opened" in str(error)  # noqa: PT017 - either is correct


@pytest.mark.parametrize(
    ("metadata", "reason"),
    [
        ("a: [", "metadata.yaml:2: is not YAML"),
        (None, "it has neither metadata.yaml nor bag files"),
    ],
)
def test_a_folder_without_files_names_the_reason(
    tmp_path: Path, metadata: str | None, reason: str
) -> None:
    if metadata is not None:
        (tmp_path / "metadata.yaml").write_text(f"{metadata}\n", encoding="utf-8")
    with pytest.raises(FileFormatError, match=reason):
        open_bag(tmp_path)
