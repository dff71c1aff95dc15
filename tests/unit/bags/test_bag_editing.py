"""Converted, filtered and merged recordings; checks of damaged ones."""

from pathlib import Path

import pytest

from bag_samples import CHATTER, POINT, START_NS, STEP_NS, sample, write_sample
from navette.bags import BagMessage, BagTopic, BagWriter, open_bag
from navette.bags.checking import Severity, check_bag
from navette.bags.editing import MessageFilter, copy, join
from navette.bags.message_types import Decoder
from navette.bags.writing import open_writer
from navette.errors import FileFormatError, InvalidValueError, UnknownNameError
from navette.msgs import serialize
from navette.msgs.sensor_msgs.msg import CameraInfo, LaserScan

FORMATS = ("mcap", "bag", "db3")


def names_and_stamps(path: Path) -> list[tuple[str, int, bytes]]:
    with open_bag(path) as reader:
        return [(m.topic.name, m.stamp_ns, m.data) for m in reader.messages()]


def made_of(
    source: Path, target: Path, choice: MessageFilter | None = None
) -> list[int]:
    """Return the numbers of the sample's messages in the new recording."""
    with open_bag(source) as reader:
        copy(reader, open_writer(target), choice)
    return [(stamp - START_NS) // STEP_NS for _, stamp, _ in names_and_stamps(target)]


@pytest.mark.parametrize("source", FORMATS)
@pytest.mark.parametrize("target", FORMATS)
def test_every_format_is_converted_to_every_other(
    tmp_path: Path, source: str, target: str
) -> None:
    first = write_sample(tmp_path / f"a.{source}", 30)
    made_of(first, tmp_path / f"b.{target}")
    assert names_and_stamps(first) == names_and_stamps(tmp_path / f"b.{target}")
    report = check_bag(tmp_path / f"b.{target}", decode=True)
    assert (report.findings, report.messages) == ((), 30)
    with open_bag(tmp_path / f"b.{target}") as reader:
        assert {t.name for t in reader.topics if t.latched} == {"/chatter"}


def test_a_part_of_a_recording(tmp_path: Path) -> None:
    bag = write_sample(tmp_path / "a.mcap", 10)

    def taken(choice: MessageFilter) -> list[int]:
        (tmp_path / "b.mcap").unlink(missing_ok=True)
        return made_of(bag, tmp_path / "b.mcap", choice)

    odd, even = [1, 3, 5, 7, 9], [0, 2, 4, 6, 8]
    assert taken(MessageFilter(topics=("/point",))) == odd
    assert taken(MessageFilter(types=("std_msgs/String",))) == even
    assert taken(MessageFilter(regex="^/cha")) == even
    assert taken(MessageFilter(exclude="chat")) == odd
    assert taken(MessageFilter(start_ns=START_NS + 7 * STEP_NS)) == [7, 8, 9]
    assert taken(MessageFilter(end_ns=START_NS + STEP_NS)) == [0, 1]
    where = "topic == '/point' and m.point.x > 4 or t < 0"
    assert taken(MessageFilter(expression=where)) == [5, 7, 9]
    assert taken(MessageFilter(expression="len(topic) == 6")) == odd


@pytest.mark.parametrize(
    ("choice", "reason"),
    [
        (MessageFilter(regex="["), "is not a regular expression"),
        (MessageFilter(expression="m +"), "expression 'm \\+'"),
        (MessageFilter(expression="m.nothing"), "/chatter at .*'nothing' of String"),
        (MessageFilter(regex="nosuch"), "no topic is selected; .*: /chatter, /point"),
        (MessageFilter(expression="t < 0"), "no message is selected"),
        (MessageFilter(start_ns=START_NS + 1, end_ns=START_NS + 2), "no message is"),
    ],
)
@pytest.mark.parametrize("name", ["b.bag", "b.mcap", "b.db3"])
def test_invalid_filters_leave_no_file(
    tmp_path: Path, choice: MessageFilter, reason: str, name: str
) -> None:
    bag = write_sample(tmp_path / "a.mcap")
    with pytest.raises(InvalidValueError, match=reason):
        made_of(bag, tmp_path / name, choice)
    assert [each.name for each in tmp_path.iterdir()] == ["a.mcap"]


@pytest.mark.parametrize(
    ("choice", "reason"),
    [
        (MessageFilter(topics=("/point", "/no")), "topic '/no'; known: /chatter, /po"),
        (MessageFilter(types=("a/msg/B",)), "type 'a/msg/B'; known: geometry_msgs"),
    ],
)
def test_names_that_were_not_recorded_are_refused(
    tmp_path: Path, choice: MessageFilter, reason: str
) -> None:
    bag = write_sample(tmp_path / "a.mcap")
    with pytest.raises(UnknownNameError, match=reason):
        made_of(bag, tmp_path / "b.mcap", choice)
    assert [each.name for each in tmp_path.iterdir()] == ["a.mcap"]


@pytest.mark.parametrize("name", ["b.bag", "b.mcap", "b.db3"])
def test_a_failure_does_not_replace_a_file(tmp_path: Path, name: str) -> None:
    bag, before = write_sample(tmp_path / "a.mcap"), write_sample(tmp_path / name)
    data = before.read_bytes()
    with open_bag(bag) as reader, pytest.raises(InvalidValueError):
        copy(
            reader,
            open_writer(before, overwrite=True),
            MessageFilter(expression="m.no"),
        )
    assert before.read_bytes() == data


def test_merged_recordings_are_in_time_order(tmp_path: Path) -> None:
    for name, part in (("a.bag", sample(9)[::3]), ("b.db3", sample(9)[1::3])):
        writer = open_writer(tmp_path / name)
        for message in part:
            writer.write(message)
        writer.close()
    with join([tmp_path / "a.bag", tmp_path / "b.db3"]) as reader:
        copy(reader, open_writer(tmp_path / "c.mcap"))
    stamps = [stamp for _, stamp, _ in names_and_stamps(tmp_path / "c.mcap")]
    assert stamps == [START_NS + n * STEP_NS for n in (0, 1, 3, 4, 6, 7)]
    with open_bag(tmp_path / "c.mcap") as reader:
        assert {t.name for t in reader.topics} == {"/chatter", "/point"}


def test_files_are_not_replaced_without_overwrite(tmp_path: Path) -> None:
    bag = write_sample(tmp_path / "a.mcap")
    with pytest.raises(FileFormatError, match="exists already"):
        open_writer(bag)
    for name in ("b.mcap", "b.bag", "b.db3"):
        (tmp_path / name).write_text("some text", "utf-8")
        with pytest.raises(FileFormatError, match="exists, is not a bag"):
            open_writer(tmp_path / name, overwrite=True)
    with pytest.raises(FileFormatError, match="folder does not exist"):
        open_writer(tmp_path / "no" / "c.bag")
    with pytest.raises(InvalidValueError, match=r"\.mcap, \.db3 or \.bag"):
        open_writer(tmp_path / "c")
    for name, compression in (("c.bag", "zstd"), ("c.db3", "lz4"), ("c.mcap", "bz2")):
        with pytest.raises(InvalidValueError, match=f"compression '{compression}'"):
            open_writer(tmp_path / name, compression=compression)


def test_messages_without_a_ros1_form_are_refused(tmp_path: Path) -> None:
    writer = open_writer(tmp_path / "a.bag")
    with pytest.raises(FileFormatError, match="cannot be represented in ROS 1"):
        writer.write(sample(1)[0]._replace(stamp_ns=-1))
    with pytest.raises(FileFormatError, match="editing_none/msg/X has no definition"):
        writer.write(BagMessage(BagTopic("/x", "editing_none/msg/X"), 1, b""))
    with pytest.raises(FileFormatError, match="json messages"):
        writer.write(BagMessage(BagTopic("/x", "X", encoding="json"), 1, b""))
    writer.abandon()
    assert list(tmp_path.iterdir()) == []


def test_ros1_identifies_types_by_their_checksums(tmp_path: Path) -> None:
    """Field names differ in ROS 1, which identifies types by a checksum of the text."""
    from rosbags.rosbag1 import Reader

    from navette.bags.writing import completed

    writer = open_writer(tmp_path / "a.bag")
    for kind, message in (("CameraInfo", CameraInfo()), ("LaserScan", LaserScan())):
        topic = completed(BagTopic(f"/{kind}", f"sensor_msgs/msg/{kind}"))
        writer.write(BagMessage(topic, 1, serialize(message)))
    writer.close()
    with Reader(tmp_path / "a.bag") as reader:
        found = {c.topic: c.digest for c in reader.connections}
    assert found == {
        "/CameraInfo": "c9a58c1b0b154e0e6da7578cb991d214",
        "/LaserScan": "90c7ef2dc6895d81024acba2ac42f369",
    }


# -- damaged ---------------------------------------------------------------------


def flushed(path: Path, count: int) -> Path:
    """One chunk per ten messages, so that chunks can be recovered."""
    writer = BagWriter(path)
    channels = {
        topic: writer.add_channel(topic.name, topic.type_name, topic.definition)
        for topic in (CHATTER, POINT)
    }
    for number, message in enumerate(sample(count), start=1):
        writer.write(channels[message.topic], message.stamp_ns, message.data)
        if number % 10 == 0:
            writer.flush()
    writer.close()
    return path


def test_intact_messages_are_recovered(tmp_path: Path) -> None:
    whole = flushed(tmp_path / "a.mcap", 100)
    data = bytearray(whole.read_bytes())
    with open_bag(whole) as reader:
        places = [chunk.position for chunk in reader.chunks]  # type: ignore[attr-defined]
    data[places[4] + 60] ^= 0xFF  # inside the fifth chunk's data
    del data[places[8] + 40 :]  # and the ninth is cut
    (tmp_path / "b.mcap").write_bytes(data)
    report = check_bag(tmp_path / "b.mcap")
    assert not report.is_sound
    assert report.messages == 70
    lost: list[object] = []
    with open_bag(tmp_path / "b.mcap") as reader:
        assert "the summary cannot be read" in reader.problems[0]
        with pytest.raises(FileFormatError, match=f"byte {places[4]}: chunk"):
            list(reader.messages())
        copy(reader, open_writer(tmp_path / "c.mcap"), on_damage=lost.append)
    assert len(lost) == 1
    assert check_bag(tmp_path / "c.mcap").is_sound
    good = [m for n, m in enumerate(sample(80)) if n // 10 != 4]
    assert names_and_stamps(tmp_path / "c.mcap") == [
        (m.topic.name, m.stamp_ns, m.data) for m in good
    ]


@pytest.mark.parametrize("suffix", ["mcap", "bag"])
def test_reading_resumes_after_a_damaged_record(tmp_path: Path, suffix: str) -> None:
    """The length of the third chunk is invalid, and there is no index."""
    path = flushed(tmp_path / "a.mcap", 100)
    if suffix == "bag":
        from rosbags.rosbag1 import Writer

        writer = open_writer(tmp_path / "a.bag")
        inner = writer._writer  # type: ignore[attr-defined]
        assert isinstance(inner, Writer)
        inner.chunk_threshold = 600
        with open_bag(path) as reader:
            copy(reader, writer)
        path = tmp_path / "a.bag"
    with open_bag(path) as reader:
        places = [chunk.position for chunk in reader.chunks]  # type: ignore[attr-defined]
    data = bytearray(path.read_bytes())
    data[places[2] + (1 if suffix == "mcap" else 0) :][:4] = b"\xff\xff\xff\x7f"
    start = places[2] + (1 if suffix == "mcap" else 0)
    data[start : start + 4] = b"\xff\xff\xff\x7f"
    del data[-40:]
    path.write_bytes(data)
    if suffix == "bag":
        position = data.index(b"index_pos=") + len(b"index_pos=")
        data[position : position + 8] = bytes(8)
        path.write_bytes(data)
    with open_bag(path) as reader:
        assert any("damaged record" in each for each in reader.problems)
        found = [m.stamp_ns for m in reader.messages()]
        assert found == sorted(found)
        assert 80 <= len(found) < 100
        assert found[-1] == START_NS + 99 * STEP_NS


def test_findings_describe_the_problem(tmp_path: Path) -> None:
    path = flushed(tmp_path / "a.mcap", 30)
    sound = path.read_bytes()
    with open_bag(path) as reader:
        chunk = reader.chunks[1]  # type: ignore[attr-defined]
    index = chunk.position + chunk.length

    def findings(position: int, value: int) -> str:
        data = bytearray(sound)
        data[position] ^= value
        path.write_bytes(data)
        return "; ".join(each.text for each in check_bag(path).findings)

    assert "its checksum is another one" in findings(chunk.position + 33, 1)
    assert "header and index disagree" in findings(chunk.position + 9, 1)
    assert "its index lacks" in findings(index + 9 + 6 + 1, 1)
    assert "the footer is missing" in findings(len(sound) - 1, 1)
    assert "the magic bytes are missing" in findings(1, 1)


def test_decreasing_stamps_are_a_warning(tmp_path: Path) -> None:
    writer = open_writer(tmp_path / "a.mcap")
    for message in (*sample(6)[3:], *sample(3)):
        writer.write(message)
    writer.close()
    report = check_bag(tmp_path / "a.mcap")
    assert report.is_sound
    assert [f.severity for f in report.findings] == [Severity.WARNING] * 2
    texts = " ".join(each.text for each in report.findings)
    assert "/chatter: the stamps decrease 1 times" in texts


def test_messages_that_do_not_match_their_type(tmp_path: Path) -> None:
    writer = open_writer(tmp_path / "a.mcap")
    writer.write(BagMessage(POINT, 1, b"\0\1\0\0short"))
    writer.close()
    assert check_bag(tmp_path / "a.mcap").is_sound
    report = check_bag(tmp_path / "a.mcap", decode=True)
    assert "/point at 1 ns" in report.findings[0].text
    with open_bag(tmp_path / "a.mcap") as reader:
        decode = Decoder(reader.topics[0])
    with pytest.raises(ValueError, match="PointStamped"):
        decode(b"\0\1\0\0short")
