"""The bag file: its records, its bytes, and its content after a crash."""

from pathlib import Path

import pytest
from mcap.exceptions import EndOfFile
from mcap.reader import make_reader
from mcap.stream_reader import StreamReader
from rosbags.interfaces import QosDurability, QosReliability
from rosbags.rosbag2.metadata import parse_qos

from navette.bags import BagWriter, OfferedQos, RecorderParams, TopicSelection, qos_text
from navette.bags.reserve import Reserve
from navette.errors import FileFormatError, ParameterError
from navette.msgs import definition_text, serialize, type_hash
from navette.msgs.std_msgs.msg import String

STRING = "std_msgs/msg/String"


def write_greetings(path: Path, count: int = 100, *, close: bool = True) -> BagWriter:
    """A bag with ``count`` strings on two topics, 10 ms apart, flushed every 20."""
    writer = BagWriter(path)
    channels = [
        writer.add_channel(
            topic,
            STRING,
            definition_text(STRING),
            type_hash=type_hash(STRING),
            qos=qos_text([OfferedQos()]),
        )
        for topic in ("/chatter", "/echo")
    ]
    for number in range(count):
        stamp = number * 10_000_000
        payload = serialize(String(data=f"hello {number}"))
        writer.write(channels[number % 2], stamp, payload)
        if number % 20 == 19:
            writer.flush()
    if close:
        writer.close()
    return writer


def test_the_file_has_the_ros2_profile(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    write_greetings(path)
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        header = reader.get_header()
        summary = reader.get_summary()
        messages = list(reader.iter_messages())
    assert (header.profile, header.library) == ("ros2", "navette")
    assert summary is not None
    assert summary.statistics is not None
    assert summary.statistics.message_count == 100
    assert [s.name for s in summary.schemas.values()] == [STRING]
    assert {s.encoding for s in summary.schemas.values()} == {"ros2msg"}
    assert [c.topic for c in summary.channels.values()] == ["/chatter", "/echo"]
    for channel in summary.channels.values():
        assert channel.message_encoding == "cdr"
        assert channel.metadata["topic_type_hash"] == type_hash(STRING)
    assert {index.compression for index in summary.chunk_indexes} == {"zstd"}
    numbers = [m.sequence for _, c, m in messages if c.topic == "/echo"]
    assert numbers == list(range(1, 51))
    assert all(m.log_time == m.publish_time for _, _, m in messages)


def test_the_index_finds_messages_by_topic_in_both_directions(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    write_greetings(path)
    with path.open("rb") as file:
        reader = make_reader(file)
        forth, back = (
            [m.log_time for _, _, m in reader.iter_messages("/echo", reverse=reverse)]
            for reverse in (False, True)
        )
    assert forth == list(range(10_000_000, 1_000_000_000, 20_000_000))
    assert back == forth[::-1]


def test_an_empty_recording_is_a_valid_file(tmp_path: Path) -> None:
    BagWriter(tmp_path / "a.mcap").close()
    with (tmp_path / "a.mcap").open("rb") as file:
        assert list(make_reader(file, validate_crcs=True).iter_messages()) == []


def test_the_same_messages_give_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a", "b"):
        write_greetings(tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_chunks_end_by_size(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    writer = BagWriter(path)
    channel = writer.add_channel("/chatter", STRING, definition_text(STRING))
    for number in range(100):
        writer.write(channel, number, bytes(20_000))
    writer.close()
    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    sizes = [index.uncompressed_size for index in summary.chunk_indexes]
    assert len(sizes) > 5
    assert max(sizes) < 300_000


def test_an_unfinished_file_is_readable_up_to_its_last_flush(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    writer = write_greetings(path, 115, close=False)
    assert read_unfinished(path) == 100
    writer.abandon()


def read_unfinished(path: Path) -> int:
    """Return the number of messages found without an index."""
    count = 0
    with path.open("rb") as file:
        records = iter(StreamReader(file, record_size_limit=None).records)
        try:
            for record in records:
                count += type(record).__name__ == "Message"
        except EndOfFile:
            return count
    raise AssertionError("the file has an end, so it was finished")


def test_space_for_the_index_is_reserved(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    writer = BagWriter(path)
    text = definition_text(STRING)
    channels = [writer.add_channel(f"/chatter{n}", STRING, text) for n in range(9)]
    for stamp in range(700):
        for channel in channels:
            writer.write(channel, stamp, b"\0\1\0\0\1\0\0\0\0")
        writer.flush()
    kept = writer._reserve.size
    assert [each.name for each in tmp_path.iterdir()] == ["a.mcap"]
    end_of_chunks = path.stat().st_size
    writer.close()
    index = path.stat().st_size - end_of_chunks
    assert 100_000 < index <= writer._mcap.index_size < 1.1 * index
    assert index <= kept


def test_without_temporary_files_no_space_is_reserved(tmp_path: Path) -> None:
    reserve = Reserve(tmp_path / "no folder")
    reserve.grow(1000)
    assert reserve.size == 0
    reserve.release()


def test_a_file_that_cannot_be_created_is_named(tmp_path: Path) -> None:
    missing = tmp_path / "no" / "folder" / "a.mcap"
    with pytest.raises(FileFormatError, match=r"a\.mcap: cannot be written: No such"):
        BagWriter(missing)
    with pytest.raises(FileFormatError, match="cannot be written: Is a directory"):
        BagWriter(tmp_path)


def test_a_bag_is_replaced_on_request_and_nothing_else_is(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    path.touch()  # an empty file is not a recording
    before = write_greetings(path, 10).path.read_bytes()
    with pytest.raises(FileFormatError, match=r"run.mcap: exists already; --overwrite"):
        BagWriter(path)
    assert path.read_bytes() == before
    BagWriter(path, overwrite=True).close()
    BagWriter(tmp_path / "b").close()
    assert path.read_bytes() == (tmp_path / "b").read_bytes()
    notes = tmp_path / "notes.txt"
    notes.write_text("precious")
    for overwrite in (False, True):
        with pytest.raises(FileFormatError, match=r"notes.txt: exists, is not a bag"):
            BagWriter(notes, overwrite=overwrite)
    assert notes.read_text() == "precious"
    with pytest.raises(FileFormatError, match="/dev/null: exists, is not a bag"):
        BagWriter(Path("/dev/null"), overwrite=True)
    left = {each.name for each in tmp_path.iterdir()}
    assert left == {"b", "notes.txt", "run.mcap"}


def test_closing_twice_has_no_effect(tmp_path: Path) -> None:
    writer = write_greetings(tmp_path / "a.mcap", 5)
    writer.close()
    writer.abandon()
    assert writer.message_count == 5


def test_quality_of_service_is_that_of_rosbag2() -> None:
    latched = OfferedQos(depth=1, durability="transient_local")
    sensor = OfferedQos(depth=5, reliability="best_effort", deadline_ns=1_500_000_000)
    first, second = parse_qos(qos_text([latched, sensor]))
    assert (first.depth, first.durability) == (1, QosDurability.TRANSIENT_LOCAL)
    assert first.lifespan == (9223372036, 854775807)
    assert second.reliability == QosReliability.BEST_EFFORT
    assert second.deadline == (1, 500_000_000)
    assert qos_text([]) == ""


@pytest.mark.parametrize(
    ("selection", "topic", "type_name", "taken"),
    [
        (TopicSelection(), "/lidar", "sensor_msgs/msg/LaserScan", True),
        (TopicSelection(), "/camera", "sensor_msgs/msg/Image", False),
        (TopicSelection(), "/fib/_action/status", "x/msg/Y", False),
        (TopicSelection(images=True), "/camera", "sensor_msgs/msg/Image", True),
        (TopicSelection(topics=("/camera",)), "/camera", "sensor_msgs/msg/Image", True),
        (TopicSelection(topics=("/camera",)), "/lidar", STRING, False),
        (TopicSelection(regex="^/odom"), "/odom/filtered", STRING, True),
        (TopicSelection(regex="^/odom"), "/lidar", STRING, False),
        (TopicSelection(topics=("/a",), regex="b"), "/b", STRING, True),
        (TopicSelection(exclude="tf"), "/tf_static", STRING, False),
        (TopicSelection(exclude="tf", topics=("/tf",)), "/tf", STRING, True),
        (TopicSelection(regex="_action"), "/fib/_action/status", STRING, True),
    ],
)
def test_topics_are_selected(
    selection: TopicSelection, topic: str, type_name: str, taken: bool
) -> None:
    assert selection.takes(topic, type_name) is taken


def test_an_invalid_pattern_is_named() -> None:
    with pytest.raises(ParameterError, match=r"'exclude'.*not a regular expression"):
        RecorderParams(exclude="(")
