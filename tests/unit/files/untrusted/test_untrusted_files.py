"""Files of unknown kind and size."""

import os
from pathlib import Path

import pytest

from navette.errors import FileFormatError
from navette.files.untrusted import Budget, BudgetError, BudgetMeter
from navette.files.untrusted.files import open_regular, read_bounded

SMALL = Budget(octets=4, items=2, depth=2)


def test_only_regular_files_are_opened(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for name, reason in (
        ("pipe", "is a named pipe"),
        (".", "is a folder"),
        ("none", "No such file"),
    ):
        with pytest.raises(FileFormatError, match=reason):
            open_regular(tmp_path / name)
    with pytest.raises(FileFormatError, match="is a device"):
        open_regular(Path("/dev/null"))
    (tmp_path / "a").write_bytes(b"abc")
    with open_regular(tmp_path / "a") as file:
        assert file.read() == b"abc"


def test_reading_is_bounded(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"abcd")
    assert read_bounded(tmp_path / "a", SMALL) == b"abcd"
    (tmp_path / "a").write_bytes(b"abcde")
    with pytest.raises(FileFormatError, match="more than 4 bytes"):
        read_bounded(tmp_path / "a", SMALL)
    with pytest.raises(FileFormatError, match="more than 4 bytes"):
        read_bounded(Path("/dev/zero"), SMALL)


def test_a_meter_counts_octets_items_and_depth() -> None:
    meter = BudgetMeter(SMALL)
    meter.spend_octets(4)
    meter.spend_items(2)
    with meter.nested(), meter.nested(), pytest.raises(BudgetError, match="than 2"):
        meter.enter()
    with pytest.raises(BudgetError, match="at most 4"):
        meter.spend_octets(1)
    with pytest.raises(BudgetError, match="more than 2 records"):
        meter.spend_items(1, "records")
    with pytest.raises(BudgetError, match="3 names; at most 2"):
        SMALL.check_items(3, "names")
