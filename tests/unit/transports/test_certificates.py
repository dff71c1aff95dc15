"""Keys and certificates of machines."""

import datetime
from pathlib import Path

import pytest

from navette.errors import FileFormatError
from navette.transports.certificates import create_keys


def test_a_folder_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.touch()
    now = datetime.datetime(2026, 1, 1, tzinfo=datetime.UTC)
    with pytest.raises(FileFormatError, match=r"x: cannot be written: Not a directory"):
        create_keys(file / "x", ["robot"], now=now)
