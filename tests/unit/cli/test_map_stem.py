"""Names of map files."""

from pathlib import Path

import pytest

from navette.cli.map_stem import map_stem
from navette.errors import InvalidValueError


@pytest.mark.parametrize("name", ["office", "office.yaml", "office.pgm"])
def test_a_suffix_is_optional(tmp_path: Path, name: str) -> None:
    assert map_stem(tmp_path / name) == tmp_path / "office"


def test_other_dots_belong_to_the_name() -> None:
    assert map_stem(Path("floor.2")) == Path("floor.2")


@pytest.mark.parametrize("name", ["", ".", "..", "/", "folder", "folder/"])
def test_a_folder_is_not_a_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    (tmp_path / "folder").mkdir()
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InvalidValueError, match="is a folder; name the map"):
        map_stem(Path(name))
