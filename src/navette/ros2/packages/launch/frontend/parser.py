"""Parser of XML and YAML launch files; creates the actions of Python launch files."""

import importlib
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from navette.errors import FileFormatError, NavetteError
from navette.files.untrusted.budget import DOCUMENT
from navette.files.untrusted.files import read_bounded
from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.errors import InvalidLaunchFileError
from navette.ros2.packages.launch.frontend.element import Element
from navette.ros2.packages.launch.frontend.xml_files import read_xml
from navette.ros2.packages.launch.frontend.yaml_files import read_yaml
from navette.ros2.packages.launch.launch_description import LaunchDescription
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
)

FORMATS: dict[str, Callable[[bytes, Path], Element]] = {
    ".xml": read_xml,
    ".launch": read_xml,
    ".yaml": read_yaml,
    ".yml": read_yaml,
}
"""File ending → reader."""

#: Tag of ROS 1 → what to write instead.
_OF_ROS_1 = {
    "machine": "start a launch on each machine",
    "param": '<param> inside <node>, or <set_parameter name="…" value="…"/>',
    "remap": '<remap> inside <node>, or <set_remap from="…" to="…"/>',
    "rosparam": '<param from="FILE"/> inside <node>',
    "test": "launch_testing",
}

EntityMaker = Callable[[Element], LaunchDescriptionEntity]
ACTIONS: dict[str, EntityMaker] = {}
"""Tag → factory of its action."""

# Modules that fill the table, imported late: they import the actions, and the include
# action imports this parser. ROS 2 uses entry points for the same reason.
EXTENSIONS = ["navette.ros2.launch.tags"]

MakerT = TypeVar("MakerT", bound=EntityMaker)


def makes(tag: str) -> Callable[[MakerT], MakerT]:
    """Register a function as the factory of a tag's entity."""

    def register(maker: MakerT) -> MakerT:
        ACTIONS[tag] = maker
        return maker

    return register


def parse_launch_file(path: Path, ending: str | None = None) -> LaunchDescription:
    """Read a file; ``ending`` overrides the format given by the file name.

    Raises:
        InvalidLaunchFileError: names the file, line and tag.
    """
    try:
        text = read_bounded(path, DOCUMENT)
        return parse_launch_text(text, path, ending or path.suffix)
    except FileFormatError as error:
        raise InvalidLaunchFileError(str(error)) from error


def parse_launch_text(text: bytes, path: Path, ending: str) -> LaunchDescription:
    """Parse the text of a launch file."""
    return parse_root(FORMATS[ending](text, path))


def parse_root(root: Element) -> LaunchDescription:
    """Create the description of a launch file's outermost element."""
    if root.tag != "launch":
        raise root.error("expected <launch> as the outermost tag")
    root.value("version")
    description = LaunchDescription(
        parse_elements(root.rest()), deprecated_reason=root.text("deprecated")
    )
    root.finish()
    return description


def parse_elements(elements: list[Element]) -> list[LaunchDescriptionEntity]:
    """Create the entities of elements, in order."""
    return [parse_element(element) for element in elements]


def parse_element(element: Element) -> LaunchDescriptionEntity:
    """Create the entity of an element.

    Raises:
        FileFormatError: unknown tag, or what is wrong with its attributes.
    """
    for name in EXTENSIONS:
        importlib.import_module(name)
    if element.tag in _OF_ROS_1:
        raise element.error(
            f"a tag of ROS 1's launch files; instead: {_OF_ROS_1[element.tag]}"
        )
    if element.tag not in ACTIONS:
        raise element.error(f"unknown tag; known: {', '.join(sorted(ACTIONS))}")
    try:
        entity = ACTIONS[element.tag](element)
    except FileFormatError:
        raise
    except NavetteError as error:
        raise element.error(str(error)) from error
    if isinstance(entity, Action):
        entity.origin = element.origin
    element.finish()
    return entity
