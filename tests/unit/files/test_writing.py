"""Failures to write a file."""

from pathlib import Path

import pytest

from navette.errors import FileFormatError
from navette.files.writing import writing


def test_a_failure_names_the_file_and_the_reason(tmp_path: Path) -> None:
    path = tmp_path / "missing" / "a.txt"
    with (
        pytest.raises(FileFormatError, match=r"a\.txt: cannot be written: No such"),
        writing(path),
    ):
        (path.parent / ".a.txt.part").write_text("", encoding="utf-8")
