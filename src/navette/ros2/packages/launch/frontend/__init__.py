"""Launch files in XML and YAML."""

from navette.ros2.packages.launch.frontend.element import Element
from navette.ros2.packages.launch.frontend.extending import (
    Parser,
    expose_action,
    expose_substitution,
)
from navette.ros2.packages.launch.frontend.grammar import (
    SUBSTITUTIONS,
    parse_if_substitutions,
    parse_substitution,
)
from navette.ros2.packages.launch.frontend.parser import (
    FORMATS,
    makes,
    parse_elements,
    parse_launch_file,
    parse_launch_text,
)

#: ROS 2's name of an element.
Entity = Element

__all__ = [
    "FORMATS",
    "SUBSTITUTIONS",
    "Element",
    "Entity",
    "Parser",
    "expose_action",
    "expose_substitution",
    "makes",
    "parse_elements",
    "parse_launch_file",
    "parse_if_substitutions",
    "parse_launch_text",
    "parse_substitution",
]
