"""rosbag2_py: what its tutorials do, over Navette's bags."""

from pathlib import Path

import pytest

from navette.bags import open_bag
from navette.errors import FileFormatError, InvalidValueError
from navette.msgs.std_msgs.msg import String
from navette.ros2.packages import rosbag2_py
from navette.runtime import (
    DurabilityPolicy,
    QoSProfile,
    deserialize_message,
    serialize_message,
)

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def options(folder: Path, **kwargs: int) -> rosbag2_py.StorageOptions:
    return rosbag2_py.StorageOptions(str(folder), "mcap", **kwargs)


def topic(name: str, *, qos: QoSProfile | None = None) -> rosbag2_py.TopicMetadata:
    return rosbag2_py.TopicMetadata(
        id=0,
        name=name,
        type="std_msgs/msg/String",
        serialization_format="cdr",
        offered_qos_profiles=[] if qos is None else [qos],
    )


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """Write ten messages on two topics, by a writer that is only deleted."""
    writer = rosbag2_py.SequentialWriter()
    writer.open(options(tmp_path / "bag"), rosbag2_py.ConverterOptions("", ""))
    writer.create_topic(topic("/chatter", qos=LATCHED))
    writer.create_topic(topic("/other"))
    for i in range(10):
        name = "/chatter" if i % 2 == 0 else "/other"
        data = serialize_message(String(data=f"message {i}"))
        writer.write(name, data, (i + 1) * 1_000_000_000)
    del writer
    return tmp_path / "bag"


def read(reader: rosbag2_py.SequentialReader) -> list[tuple[str, str, int]]:
    found = []
    while reader.has_next():
        name, data, stamp_ns = reader.read_next()
        text = deserialize_message(data, String).data
        found.append((name, text, stamp_ns // 1_000_000_000))
    return found


def test_what_was_written_is_read(bag: Path) -> None:
    reader = rosbag2_py.SequentialReader()
    reader.open(
        rosbag2_py.StorageOptions(uri=str(bag), storage_id="mcap"),
        rosbag2_py.ConverterOptions(
            input_serialization_format="cdr", output_serialization_format="cdr"
        ),
    )
    types = {each.name: each.type for each in reader.get_all_topics_and_types()}
    assert types == dict.fromkeys(("/chatter", "/other"), "std_msgs/msg/String")
    (qos,) = reader.get_all_topics_and_types()[0].offered_qos_profiles
    assert (qos.depth, qos.durability) == (1, DurabilityPolicy.TRANSIENT_LOCAL)
    (definition,) = reader.get_all_message_definitions()
    assert definition.encoded_message_definition == "string data\n"
    found = read(reader)
    assert found[:2] == [("/chatter", "message 0", 1), ("/other", "message 1", 2)]
    assert len(found) == 10
    with pytest.raises(RuntimeError, match="No next message"):
        reader.read_next()
    reader.close()


def test_filters_and_seeks(bag: Path) -> None:
    reader = rosbag2_py.SequentialReader()
    reader.open_uri(str(bag))
    reader.set_filter(rosbag2_py.StorageFilter(topics=["/other"]))
    assert [stamp for _, _, stamp in read(reader)] == [2, 4, 6, 8, 10]
    reader.seek(5_000_000_000)
    assert [stamp for _, _, stamp in read(reader)] == [6, 8, 10]
    reader.seek(0)
    reader.reset_filter()
    reader.set_filter(rosbag2_py.StorageFilter(regex="^/chat"))
    assert {name for name, _, _ in read(reader)} == {"/chatter"}
    reader.close()
    limits = rosbag2_py.StorageOptions(
        str(bag), start_time_ns=3_000_000_000, end_time_ns=4_000_000_000
    )
    reader.open(limits)
    assert [stamp for _, _, stamp in read(reader)] == [3, 4]
    reader.close()


def test_metadata(bag: Path) -> None:
    metadata = rosbag2_py.Info().read_metadata(str(bag), "mcap")
    assert metadata.message_count == 10
    assert metadata.starting_time.nanoseconds == 1_000_000_000
    assert metadata.duration.nanoseconds == 9_000_000_000
    assert metadata.relative_file_paths == ["bag_0.mcap"]
    counts = [each.message_count for each in metadata.topics_with_message_count]
    assert counts == [5, 5]


def test_a_bag_of_sqlite_is_written(tmp_path: Path) -> None:
    writer = rosbag2_py.SequentialWriter()
    writer.open(rosbag2_py.StorageOptions(str(tmp_path / "new"), "sqlite3"))
    writer.create_topic(topic("/chatter"))
    for second in (1, 2):
        data = serialize_message(String(data=str(second)))
        writer.write("/chatter", data, second * 1_000_000_000)
    del writer
    metadata = rosbag2_py.Info().read_metadata(str(tmp_path / "new"), "sqlite3")
    assert metadata.message_count == 2
    assert metadata.storage_identifier == "sqlite3"
    with open_bag(tmp_path / "new") as reader:
        stamps = [m.stamp_ns // 1_000_000_000 for m in reader.messages()]
    assert stamps == [1, 2]


def test_files_are_split(tmp_path: Path) -> None:
    writer = rosbag2_py.SequentialWriter()
    writer.open(options(tmp_path / "split", max_bagfile_duration=2))
    writer.create_topic(topic("/chatter"))
    for second in range(1, 7):
        data = serialize_message(String(data=str(second)))
        writer.write("/chatter", data, second * 1_000_000_000)
    writer.close()
    with open_bag(tmp_path / "split") as reader:
        assert len(reader.files) == 3
        assert [m.stamp_ns // 1_000_000_000 for m in reader.messages()] == [
            *range(1, 7)
        ]


def test_misuse_is_reported(bag: Path, tmp_path: Path) -> None:
    writer = rosbag2_py.SequentialWriter()
    with pytest.raises(RuntimeError, match="not open"):
        writer.create_topic(topic("/chatter"))
    with pytest.raises(FileFormatError, match="exists already"):
        writer.open(options(bag))
    with pytest.raises(InvalidValueError, match="storage_id 'rosbag1'"):
        writer.open(rosbag2_py.StorageOptions(str(tmp_path / "new"), "rosbag1"))
    split = rosbag2_py.StorageOptions(
        str(tmp_path / "new"), "sqlite3", max_bagfile_size=1000
    )
    with pytest.raises(InvalidValueError, match="'sqlite3' is one file"):
        writer.open(split)
    writer.open(options(tmp_path / "new"))
    with pytest.raises(RuntimeError, match="'/chatter' has not been created"):
        writer.write("/chatter", b"", 0)
    writer.close()
    reader = rosbag2_py.SequentialReader()
    with pytest.raises(RuntimeError, match="not open"):
        reader.get_metadata()
    assert not reader.has_next()
    assert not reader.set_read_order(rosbag2_py.ReadOrder(reverse=True))
