"""XML and YAML launch files → the same action objects as Python files make."""

import importlib
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from navette.errors import FileFormatError, NavetteError
from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.errors import InvalidLaunchFileError
from navette.ros2.packages.launch.frontend.element import Element
from navette.ros2.packages.launch.frontend.xml_files import read_xml
from navette.ros2.packages.launch.frontend.yaml_files import read_yaml
from navette.ros2.packages.launch.launch_description import LaunchDescription
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
)

MAX_BYTES = 8 * 1024 * 1024
FORMATS: dict[str, Callable[[bytes, Path], Element]] = {
    ".xml": read_xml,
    ".launch": read_xml,
    ".yaml": read_yaml,
    ".yml": read_yaml,
}
"""File ending → reader."""

EntityMaker = Callable[[Element], LaunchDescriptionEntity]
ACTIONS: dict[str, EntityMaker] = {}
"""Tag → what makes the action of an element."""

# What fills the table. Named by strings, because the makers need the actions, and
# the include action needs this parser: ROS 2 has entry points for the same reason.
EXTENSIONS = ["navette.ros2.launch.tags"]

MakerT = TypeVar("MakerT", bound=EntityMaker)


def expose_action(tag: str) -> Callable[[MakerT], MakerT]:
    """Let a function make the entities of a tag."""

    def expose(maker: MakerT) -> MakerT:
        ACTIONS[tag] = maker
        return maker

    return expose


def parse_launch_file(path: Path, ending: str | None = None) -> LaunchDescription:
    """Read a file; ``ending`` chooses another format than the file's name does.

    Raises:
        InvalidLaunchFileError: names file, line and tag.
    """
    try:
        if path.stat().st_size > MAX_BYTES:
            raise InvalidLaunchFileError(f"{path}: more than {MAX_BYTES} bytes")
        text = path.read_bytes()
    except OSError as error:
        raise InvalidLaunchFileError(f"{path}: {error.strerror}") from error
    try:
        return parse_launch_text(text, path, ending or path.suffix)
    except FileFormatError as error:
        raise InvalidLaunchFileError(str(error)) from error


def parse_launch_text(text: bytes, path: Path, ending: str) -> LaunchDescription:
    """As :func:`parse_launch_file`, from the text itself."""
    root = FORMATS[ending](text, path)
    if root.tag != "launch":
        raise root.error("wanted <launch> as the outermost tag")
    root.value("version")
    description = LaunchDescription(parse_elements(root.rest()))
    root.finish()
    return description


def parse_elements(elements: list[Element]) -> list[LaunchDescriptionEntity]:
    """The entities of elements, in order."""
    for name in EXTENSIONS:
        importlib.import_module(name)
    return [_parse(element) for element in elements]


def _parse(element: Element) -> LaunchDescriptionEntity:
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
