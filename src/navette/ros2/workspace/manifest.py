"""Reader of package.xml (REP 127, 140, 149)."""

import re
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element, ParseError

from defusedxml.common import DefusedXmlException
from defusedxml.ElementTree import fromstring

from navette.errors import FileFormatError

FILE_NAME = "package.xml"
_NAME = re.compile(r"[a-zA-Z0-9][a-zA-Z0-9_-]+", re.ASCII)
_DEPENDENCY_TAGS = (
    "depend",
    "build_depend",
    "build_export_depend",
    "exec_depend",
    "run_depend",
)


@dataclass(frozen=True, slots=True)
class Manifest:
    """The parts of a package.xml that Navette uses."""

    name: str
    version: str
    description: str
    build_type: str
    #: Packages required to build or run, in the file's order; not those of tests.
    dependencies: tuple[str, ...]


def read_manifest(path: Path) -> Manifest:
    """Read a package.xml.

    Raises:
        FileFormatError: the file is not XML, or has no package with a valid name.
    """
    try:
        root = fromstring(path.read_text(encoding="utf-8"))
    except (ParseError, DefusedXmlException, UnicodeDecodeError) as error:
        raise FileFormatError(path, f"not readable as XML: {error}") from None
    if root.tag != "package":
        raise FileFormatError(path, f"<{root.tag}>: expected <package>")
    name = _text(root, "name")
    if not is_package_name(name):
        raise FileFormatError(path, f"<name> {name!r} is not a valid package name")
    names = (e.text or "" for tag in _DEPENDENCY_TAGS for e in root.iter(tag))
    return Manifest(
        name=name,
        version=_text(root, "version"),
        description=" ".join(_text(root, "description").split()),
        build_type=_text(root, "export/build_type") or "catkin",
        dependencies=tuple(dict.fromkeys(each.strip() for each in names)),
    )


def is_package_name(name: str) -> bool:
    """Whether REP 127 and its recommended exemptions allow the name."""
    return _NAME.fullmatch(name) is not None


def _text(root: Element, tag: str) -> str:
    return (root.findtext(tag) or "").strip()
