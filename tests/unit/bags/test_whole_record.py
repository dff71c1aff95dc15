"""Copies keep everything that was recorded, or list what their format cannot hold."""

import sqlite3
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from mcap.writer import CompressionType, Writer

from bag_samples import START_NS, STEP_NS, write_sample
from mcap_content import mcap_content
from navette.bags import BagReader, open_bag
from navette.bags.checking import check_bag
from navette.bags.editing import MessageFilter, copy, join
from navette.bags.message_types import Decoder
from navette.bags.summary import summarise
from navette.bags.topic_writer import TopicWriter
from navette.bags.writing import open_writer
from navette.msgs import serialize
from navette.msgs.std_msgs.msg import String

SEPARATOR = "=" * 80 + "\n"
SCHEMAS: list[tuple[str, str, bytes, str]] = [
    ("std_msgs/msg/String", "ros2msg", b"string data\n", "cdr"),
    ("std_msgs/String", "ros1msg", b"string data\n", "ros1"),
    ("whole_record/msg/Idl", "ros2idl", b"", "cdr"),
    ("Beep", "jsonschema", b'{"type": "object"}', "json"),
    ("foo.Bar", "protobuf", bytes(range(256)), "protobuf"),
    ("foo", "flatbuffer", b"\0\1\2", "flatbuffer"),
    ("unknown_msgs/srv/Do_Event", "unknown", b"", "cdr"),
    ("unknown_msgs/msg/Empty", "ros2msg", b"", "cdr"),
]
EMPTY = b"\0\1\0\0\0"
PAYLOADS = {
    "cdr": serialize(String(data="hello")),
    "ros1": b"\5\0\0\0hello",
    "json": b'{"a": 1}',
    "protobuf": b"\x08\x01",
    "flatbuffer": b"\x28\xb5\x2f\xfd but not zstd",
}


def write_all(path: Path, **options: Any) -> Path:
    """A file with everything that MCAP can hold."""
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=300, **options)
        writer.start("course", "test")
        channels = []
        for number, (name, encoding, data, message_encoding) in enumerate(SCHEMAS):
            schema = writer.register_schema(name, encoding, data)
            for publisher in ("a", "b"):
                keys = {"callerid": publisher, "key": "value"}
                channel = writer.register_channel(
                    f"/{number}", message_encoding, schema, keys
                )
                data = PAYLOADS[message_encoding]
                channels.append((channel, EMPTY if "Empty" in name else data))
        empty = writer.register_channel("/bare", "", 0, {})
        channels.append((empty, b"\1\2\3"))
        writer.register_channel("/silent", "json", 0, {"no": "messages"})
        writer.add_attachment(3, 4, "calibration.yaml", "text/yaml", b"k: 1\n" * 99)
        writer.add_metadata("vehicle", {"name": "burger", "weight": "1 kg"})
        for step in range(5):
            for place, (channel, data) in enumerate(channels):
                stamp = 1000 * (step + 1) + place
                writer.add_message(channel, stamp, data, stamp - 7, 100 - step)
        writer.add_message(channels[0][0], 2**64 - 1, PAYLOADS["cdr"], 0, 2**32 - 1)
        writer.add_attachment(5, 6, "", "", b"")
        writer.finish()
    return path


def copied(source: Path | BagReader, target: Path, **given: Any) -> TopicWriter:
    reader = open_bag(source) if isinstance(source, Path) else source
    with reader:
        writer = open_writer(target, profile=reader.profile or "ros2")
        copy(reader, writer, MessageFilter(**given))
    return writer


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"use_chunking": False},
        {"compression": CompressionType.NONE},
        {"use_summary_offsets": False, "use_statistics": False},
        {"index_types": 0},
    ],
    ids=str,
)
def test_an_mcap_copy_is_complete(tmp_path: Path, options: dict[str, Any]) -> None:
    if options.get("index_types") == 0:
        from mcap.writer import IndexType

        options = {"index_types": IndexType.NONE}
    source = write_all(tmp_path / "a.mcap", **options)
    writer = copied(source, tmp_path / "b.mcap")
    before, after = mcap_content(source), mcap_content(tmp_path / "b.mcap")
    assert after == before
    assert len(before.messages) == 5 * 17 + 1
    assert len(before.channels) == 18
    assert not writer.losses
    assert check_bag(tmp_path / "b.mcap", decode=True).is_sound


def test_a_filter_keeps_everything_of_its_topics(tmp_path: Path) -> None:
    source = write_all(tmp_path / "a.mcap")
    copied(source, tmp_path / "b.mcap", topics=("/1", "/3"), start_ns=2000)
    before, after = mcap_content(source), mcap_content(tmp_path / "b.mcap")
    kept = [m for m in before.messages if m[0][0] in ("/1", "/3") and m[2] >= 2000]
    assert after.messages == kept
    assert after.attachments == before.attachments
    assert after.metadata == before.metadata


def test_an_expression_reads_messages_of_ros1(tmp_path: Path) -> None:
    source = write_all(tmp_path / "a.mcap")
    kept = "m.data == 'hello'"
    copied(source, tmp_path / "b.mcap", topics=("/1",), expression=kept)
    after = mcap_content(tmp_path / "b.mcap")
    assert len(after.messages) == 10
    assert {m[4] for m in after.messages} == {PAYLOADS["ros1"]}


def test_a_merge_is_complete(tmp_path: Path) -> None:
    paths = [write_all(tmp_path / name) for name in ("a.mcap", "b.mcap")]
    copied(join(paths), tmp_path / "c.mcap")
    before, after = mcap_content(paths[0]), mcap_content(tmp_path / "c.mcap")
    assert after.channels == before.channels
    assert Counter(after.messages) == Counter(before.messages * 2)
    assert after.attachments == before.attachments * 2
    assert after.metadata == before.metadata * 2


def test_a_database_lists_what_it_cannot_hold(tmp_path: Path) -> None:
    source = write_all(tmp_path / "a.mcap")
    writer = copied(source, tmp_path / "b.db3")
    assert writer.losses.lines == [
        "2 attachments (calibration.yaml, )",
        "1 metadata record (vehicle)",
        "33 channel metadata entries (/0, /1, /2 and 6 more)",
        "85 publish times (/0, /1, /2 and 6 more)",
        "85 sequence numbers (/0, /1, /2 and 6 more)",
        "1 message with a stamp after 2262 (/0)",
    ]
    database = sqlite3.connect(tmp_path / "b.db3")
    query = "SELECT topic_type, encoding, encoded_message_definition"
    found = set(database.execute(f"{query} FROM message_definitions"))
    assert ("Beep", "jsonschema", '{"type": "object"}') in found
    assert ("foo.Bar", "protobuf", bytes(range(256))) in found
    assert ("unknown_msgs/srv/Do_Event", "unknown", "") in found
    query = "SELECT name, serialization_format, count(*), max(data) FROM messages"
    rows = database.execute(
        f"{query} JOIN topics ON topics.id = topic_id GROUP BY name"
    )
    data = {name: (kind, count, value) for name, kind, count, value in rows}
    database.close()
    assert data["/3"] == ("json", 10, PAYLOADS["json"])
    assert data["/4"] == ("protobuf", 10, PAYLOADS["protobuf"])
    assert data["/6"] == ("cdr", 10, PAYLOADS["cdr"])
    assert data["/bare"] == ("", 5, b"\1\2\3")
    # Back again: nothing more is lost.
    again = copied(tmp_path / "b.db3", tmp_path / "c.mcap")
    assert not again.losses
    schemas = {c[:3] for c in mcap_content(tmp_path / "c.mcap").channels}
    assert ("/4", "protobuf", ("foo.Bar", "protobuf", bytes(range(256)))) in schemas


def test_a_ros1_bag_lists_what_it_cannot_hold(tmp_path: Path) -> None:
    source = write_all(tmp_path / "a.mcap")
    writer = copied(source, tmp_path / "b.bag", end_ns=10**9)
    lines = "\n".join(writer.losses.lines)
    for text in (
        "2 attachments (calibration.yaml, )",
        "10 messages: json messages are not ROS messages (/3, /silent)",
        "10 messages: protobuf messages are not ROS messages (/4)",
        "10 messages: unknown_msgs/srv/Do_Event has no definition",
    ):
        assert text in lines, text
    with open_bag(tmp_path / "b.bag") as reader:
        counts = {topic.name: count for topic, count in reader.counts().items()}
        text = next(reader.messages(["/1"]))
        assert Decoder(text.topic)(text.data).data == "hello"
    assert counts["/0"] == counts["/1"] == 10


def test_databases_need_no_definitions(tmp_path: Path) -> None:
    """Recordings of Foxy to Humble, of types that are not installed."""
    path = tmp_path / "a.db3"
    database = sqlite3.connect(path)
    database.executescript(
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT,"
        " serialization_format TEXT, offered_qos_profiles TEXT);"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER,"
        " timestamp INTEGER, data BLOB);"
        "INSERT INTO topics VALUES(1, '/x', 'unknown_msgs/msg/X', 'cdr', '');"
        "INSERT INTO messages VALUES(1, 1, 5, x'00010000'), (2, 1, 6, x'');"
    )
    database.close()
    assert check_bag(path, decode=True).is_sound
    for name in ("b.db3", "b.mcap"):
        assert not copied(path, tmp_path / name).losses
        with open_bag(tmp_path / name) as reader:
            assert [m.data for m in reader.messages()] == [b"\0\1\0\0", b""]
            assert [t.type_name for t in reader.topics] == ["unknown_msgs/msg/X"]
    writer = copied(path, tmp_path / "b.bag")
    assert writer.losses.lines == [
        "2 messages: unknown_msgs/msg/X has no definition, which this format requires"
        " (/x)"
    ]


EVENTS = {
    "rosbag2, Jazzy": ("unknown", b""),
    "rosbag2, Kilted": (
        "ros2msg",
        f"{SEPARATOR}SRV: whole_record/srv/Add\nint64 a\n---\nint64 sum\n".encode(),
    ),
    "flat": (
        "ros2msg",
        (
            "service_msgs/ServiceEventInfo info\n"
            "whole_record/Add_Request[<=1] request\n"
            "whole_record/srv/Add_Response[<=1] response\n"
            f"{SEPARATOR}MSG: whole_record/Add_Request\nint64 a\n"
            f"{SEPARATOR}MSG: whole_record/srv/Add_Response\nint64 sum\n"
        ).encode(),
    ),
}


@pytest.mark.parametrize("kind", EVENTS)
def test_service_events_are_sound_and_read(tmp_path: Path, kind: str) -> None:
    encoding, text = EVENTS[kind]
    path = tmp_path / "a.mcap"
    event = (
        b"\0\1\0\0" + bytes([1]) + bytes(3) + bytes(8) + bytes(16) + bytes(4)
        + (7).to_bytes(8, "little")
        + (1).to_bytes(4, "little") + bytes(4) + (41).to_bytes(8, "little")
        + bytes(4)
    )  # fmt: skip
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start("ros2", "test")
        name = "whole_record/srv/Add_Event"
        schema = writer.register_schema(name, encoding, text)
        channel = writer.register_channel("/add/_service_event", "cdr", schema)
        writer.add_message(channel, 1, event, 1)
        writer.finish()
    assert check_bag(path, decode=True).is_sound
    with open_bag(path) as reader:
        assert reader.problems == ()
        (message,) = reader.messages()
        if encoding == "ros2msg":
            found = Decoder(message.topic)(message.data)
            assert (found.info.event_type, found.info.sequence_number) == (1, 7)
            assert [request.a for request in found.request] == [41]
    copied(path, tmp_path / "b.mcap")
    assert mcap_content(tmp_path / "b.mcap") == mcap_content(path)
    copied(path, tmp_path / "b.db3")
    with open_bag(tmp_path / "b.db3") as reader:
        assert [m.data for m in reader.messages()] == [event]
    lines = copied(path, tmp_path / "b.bag").losses.lines
    assert len(lines) == 1, "the topic is listed and the conversion succeeds"
    assert lines[0].startswith("1 message: ")


@pytest.mark.parametrize("data", [b"", b"\0\1\0\0", b"\0\1\0\0\0"])
def test_types_without_fields_are_sound(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "a.mcap"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start("ros2", "test")
        schema = writer.register_schema("test_msgs/msg/Empty", "ros2msg", b"")
        channel = writer.register_channel("/empty", "cdr", schema)
        writer.add_message(channel, 1, data, 1)
        writer.finish()
    report = check_bag(path, decode=True)
    assert report.is_sound, report.findings
    assert report.findings == ()
    for name in ("b.mcap", "b.db3", "c.bag"):
        assert not copied(path, tmp_path / name).losses


def test_damaged_attachments_are_reported(tmp_path: Path) -> None:
    source = write_all(tmp_path / "a.mcap")
    data = bytearray(source.read_bytes())
    data[data.index(b"k: 1\n") + 3] = ord("2")
    source.write_bytes(data)
    lost: list[Any] = []
    with open_bag(source) as reader:
        copy(reader, open_writer(tmp_path / "b.mcap"), on_damage=lost.append)
    assert [each.reason for each in lost] == [
        f"byte {data.index(b'k: 2') - 66}: attachment: its checksum does not match"
    ]
    after = mcap_content(tmp_path / "b.mcap")
    assert len(after.attachments) == 1
    assert len(after.messages) == 86
    report = check_bag(source)
    texts = [finding.text for finding in report.findings]
    assert any("attachment: its checksum does not match" in text for text in texts)


def test_formats_without_channels_gain_nothing(tmp_path: Path) -> None:
    """Recordings of ROS 1 become ROS 2, with stamps as they were."""
    source = write_sample(tmp_path / "a.bag")
    copied(source, tmp_path / "b.mcap")
    after = mcap_content(tmp_path / "b.mcap")
    assert after.profile == "ros2"
    assert {channel[1] for channel in after.channels} == {"cdr"}
    stamps = [START_NS + n * STEP_NS for n in range(6)]
    assert [message[2] for message in after.messages] == stamps
    assert [message[3] for message in after.messages] == stamps


def test_channels_of_several_publishers_are_one_topic_in_the_summary(
    tmp_path: Path,
) -> None:
    with open_bag(write_all(tmp_path / "a.mcap")) as reader:
        found = {each.topic.name: each.count for each in summarise(reader).topics}
    assert len(found) == 10
    assert found["/3"] == 10
    assert found["/silent"] == 0
