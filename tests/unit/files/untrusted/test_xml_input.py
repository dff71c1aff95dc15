"""XML within a budget."""

from pathlib import Path
from xml.etree.ElementTree import Element

import pytest

from navette.errors import FileFormatError
from navette.files.untrusted import Budget
from navette.files.untrusted.xml_input import parse_xml


class Elements:
    """The standard library's elements."""

    def node(self, tag: str, attributes: dict[str, str], line: int) -> Element:
        return Element(tag, {**attributes, "line": str(line)})

    def add(self, parent: Element, child: Element) -> None:
        parent.append(child)

    def text(self, node: Element, text: str) -> None:
        node.text = text


def parse(text: str | bytes, **limits: int) -> Element:
    data = text if isinstance(text, bytes) else text.encode()
    budget = Budget(**{"octets": 1 << 20, "items": 1000, **limits})
    return parse_xml(data, Path("a.xml"), Elements(), budget)


def test_tree_with_lines_and_text() -> None:
    root = parse('<n:a xmlns:n="x">\n one <b c="d"/> two\n</n:a>')
    assert (root.tag, root.text, len(root)) == ("a", "\n one  two\n", 1)
    assert root[0].attrib == {"c": "d", "line": "2"}


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("<a>" * 60_000, "nested deeper than 64"),
        ("<a>" + "<b/>" * 2000 + "</a>", "more than 1000 elements"),
        ("<a " + " ".join(f'x{i}="1"' for i in range(2000)) + "/>", "more than 1000"),
        ("<a>" + " " * (2 << 20) + "</a>", "at most 1048576 are allowed"),
        ('<!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>', "refused"),
        ('<?xml version="1.0" encoding="nothing"?><a/>', "not XML"),
        (b"\xff\xfe<", "not XML"),
        ("", "not XML"),
        ("<a>\n<b></a>", "not XML"),
    ],
)
def test_hostile_text_is_a_named_error(text: str | bytes, reason: str) -> None:
    with pytest.raises(FileFormatError, match=reason):
        parse(text)
