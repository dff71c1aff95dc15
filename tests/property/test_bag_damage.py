"""Damaged recordings give the intact part or a named error, in each format."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from bag_samples import sample, shrink_pages, write_sample
from navette.bags import BagMessage, Damage, open_bag
from navette.bags.checking import check_bag
from navette.errors import FileFormatError

pytestmark = pytest.mark.long

ROS1_PADDING = range(120, 4000)
"""Padding between the first record of a ROS 1 bag and its data."""


@pytest.fixture(scope="module", params=["mcap", "bag", "db3"])
def sound(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Path:
    path = tmp_path_factory.mktemp("sound") / f"a.{request.param}"
    write_sample(path)
    if request.param == "db3":
        shrink_pages(path)
    return path


def offsets(path: Path) -> Iterator[int]:
    size = path.stat().st_size
    # Every byte counts once; SQLite is larger, and its pages are alike.
    step = 7 if path.suffix == ".db3" else 1
    for offset in range(0, size, step):
        if path.suffix != ".bag" or offset not in ROS1_PADDING:
            yield offset


def read_good_part(path: Path) -> tuple[list[BagMessage], list[Damage]] | None:
    """Return the readable messages of a file; None if it is refused."""
    lost: list[Damage] = []
    try:
        with open_bag(path) as reader:
            return list(reader.messages(on_damage=lost.append)), lost
    except FileFormatError:
        return None


def test_files_truncated_anywhere(sound: Path, tmp_path: Path) -> None:
    whole = sound.read_bytes()
    path = tmp_path / sound.name
    wanted = [(m.topic.name, m.stamp_ns, m.data) for m in sample()]
    most = 0
    for offset in offsets(sound):
        path.write_bytes(whole[:offset])
        found = read_good_part(path)
        if found is not None:
            messages = [(m.topic.name, m.stamp_ns, m.data) for m in found[0]]
            assert set(messages) <= set(wanted), f"cut at {offset}"
            most = max(most, len(messages))
    assert most == len(wanted), "cutting the index alone loses nothing"


def test_files_with_flipped_bits(sound: Path, tmp_path: Path) -> None:
    whole = sound.read_bytes()
    path = tmp_path / sound.name
    wanted = {(m.topic.name, m.stamp_ns, m.data) for m in sample()}
    for offset in offsets(sound):
        flipped = bytearray(whole)
        flipped[offset] ^= 1 << (offset % 8)
        path.write_bytes(flipped)
        found = read_good_part(path)
        if found is not None and sound.suffix == ".mcap":
            # Chunks carry a checksum: nothing false comes through.
            messages = {(m.topic.name, m.stamp_ns, m.data) for m in found[0]}
            assert messages <= wanted, f"flipped at {offset}"


@pytest.mark.parametrize("flip", [0x01, 0x80, 0xFF])
def test_checks_of_damaged_files_end_in_a_verdict(
    sound: Path, tmp_path: Path, flip: int
) -> None:
    whole = sound.read_bytes()
    path = tmp_path / sound.name
    for offset in list(offsets(sound))[::11]:
        flipped = bytearray(whole)
        flipped[offset] ^= flip
        path.write_bytes(flipped)
        report = check_bag(path, decode=True)
        assert report.is_sound or any(each.text for each in report.findings)


def test_empty_and_foreign_files(tmp_path: Path) -> None:
    for name in ("a.mcap", "a.bag", "a.db3", "a.mcap.zstd", "a.txt"):
        path = tmp_path / name
        path.write_bytes(b"")
        with pytest.raises(FileFormatError, match="is empty"):
            open_bag(path)
        path.write_bytes(b"something else " * 100)
        with pytest.raises(FileFormatError, match=r"is not|cannot be decompressed"):
            open_bag(path)
    with pytest.raises(FileFormatError, match="cannot be opened"):
        open_bag(tmp_path / "nowhere.mcap")
    (tmp_path / "folder").mkdir()
    with pytest.raises(FileFormatError, match="is not a recording"):
        open_bag(tmp_path / "folder")
