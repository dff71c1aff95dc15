"""MCAP files without optional parts are sound; files that lack records are not."""

import struct
from pathlib import Path

import pytest
from mcap.opcode import Opcode
from mcap.writer import IndexType, Writer

from navette.bags import open_bag
from navette.bags.checking import check_bag

BARE = {
    "use_statistics": False,
    "use_summary_offsets": False,
    "repeat_channels": False,
    "repeat_schemas": False,
    "index_types": IndexType.NONE,
}
COUNT = 20


def write(path: Path, **options: object) -> Path:
    with path.open("wb") as stream:
        writer = Writer(stream, **options)  # type: ignore[arg-type]
        writer.start(profile="ros2")
        schema = writer.register_schema("std_msgs/msg/Int32", "ros2msg", b"int32 data")
        channel = writer.register_channel("/count", "cdr", schema)
        for i in range(COUNT):
            payload = b"\0\1\0\0" + struct.pack("<i", i)
            writer.add_message(channel, i * 10**7, payload, i * 10**7)
        writer.finish()
    return path


@pytest.mark.parametrize(
    "options",
    [
        BARE,
        {**BARE, "use_chunking": False},
        {"use_chunking": False},
        {"index_types": IndexType.NONE},
        {"use_statistics": False},
    ],
    ids=["no summary", "no chunks", "no chunks but a summary", "no index", "no counts"],
)
def test_a_file_without_optional_parts_is_sound(
    tmp_path: Path, options: dict[str, object]
) -> None:
    path = write(tmp_path / "bag.mcap", **options)
    with open_bag(path) as bag:
        assert (bag.problems, bag.losses) == ((), ())
        assert bag.remarks == ("the file has no complete summary: all of it is read",)
        assert [each.stamp_ns for each in bag.messages()] == [
            i * 10**7 for i in range(COUNT)
        ]
        assert sum(bag.counts().values()) == COUNT
    report = check_bag(path, decode=True)
    assert report.is_sound
    assert report.messages == COUNT


def test_a_file_without_the_end_of_the_data_is_damaged(tmp_path: Path) -> None:
    path = write(tmp_path / "bag.mcap", **BARE)
    data = path.read_bytes()
    end = struct.pack("<BQ", Opcode.DATA_END, 4)
    begin = data.rindex(end)
    path.write_bytes(data[:begin] + data[begin + len(end) + 4 :])
    with open_bag(path) as bag:
        assert bag.losses == ("the record at the end of the data is missing",)


def test_fewer_messages_than_the_statistics_state_are_damage(tmp_path: Path) -> None:
    path = write(tmp_path / "bag.mcap", use_chunking=False)
    data = path.read_bytes()
    stated, wrong = struct.pack("<Q", COUNT), struct.pack("<Q", COUNT + 3)
    begin = data.rindex(struct.pack("<B", Opcode.STATISTICS) + struct.pack("<Q", 56))
    assert data[begin + 9 : begin + 17] == stated
    # The checksum of the summary is optional: 0.
    changed = data[: begin + 9] + wrong + data[begin + 17 : -12] + bytes(4) + data[-8:]
    path.write_bytes(changed)
    with open_bag(path) as bag:
        assert bag.losses == (f"messages in the file: {COUNT} of {COUNT + 3}",)
