"""Safe XML parsing; every error names file and line."""

from pathlib import Path

import pytest

from navette.errors import FileFormatError
from navette.files.untrusted import Budget
from navette.sim import xml_tree
from navette.sim.xml_tree import parse_xml


def _write(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "file.sdf"
    path.write_text(text)
    return path


def test_nodes_have_their_lines(tmp_path: Path) -> None:
    root = parse_xml(_write(tmp_path, "<a>\n <b/>\n\n <c x='1'>2 3</c>\n</a>"))
    assert [child.line for child in root.children] == [2, 4]
    assert root.need("c").numbers(2) == (2.0, 3.0)


@pytest.mark.parametrize(
    "text",
    [
        '<!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>',
        '<!DOCTYPE a SYSTEM "http://example.org/a.dtd"><a/>',
        '<!DOCTYPE a [<!ENTITY b SYSTEM "file:///etc/passwd">]><a>&b;</a>',
    ],
)
def test_document_types_and_entities_are_refused(tmp_path: Path, text: str) -> None:
    with pytest.raises(FileFormatError, match="refused"):
        parse_xml(_write(tmp_path, text))


def test_broken_xml_names_the_line(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=r"file\.sdf:3: not XML"):
        parse_xml(_write(tmp_path, "<a>\n<b>\n</a>"))


def test_limits_are_enforced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(FileFormatError, match="nested deeper"):
        parse_xml(_write(tmp_path, "<a>" * 100 + "</a>" * 100))
    monkeypatch.setattr(xml_tree, "SCENE", Budget(octets=1000, items=10))
    with pytest.raises(FileFormatError, match="more than 10 elements"):
        parse_xml(_write(tmp_path, "<a>" + "<b/>" * 20 + "</a>"))
    with pytest.raises(FileFormatError, match="more than 1000 bytes"):
        parse_xml(_write(tmp_path, "<a>" + " " * 1000 + "</a>"))


def test_missing_file(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match="cannot be read"):
        parse_xml(tmp_path / "nowhere.sdf")


@pytest.mark.parametrize("text", ["1 2", "a b c", "nan 0 0", "1e999 0 0"])
def test_numbers_are_checked(tmp_path: Path, text: str) -> None:
    root = parse_xml(_write(tmp_path, f"<a>\n<b>{text}</b></a>"))
    with pytest.raises(FileFormatError, match=r":2: <b>"):
        root.need("b").numbers(3)
