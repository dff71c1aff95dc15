"""Launch files in XML and YAML."""

from navette.ros2.packages.launch.frontend.element import Element
from navette.ros2.packages.launch.frontend.grammar import (
    SUBSTITUTIONS,
    parse_substitution,
)
from navette.ros2.packages.launch.frontend.parser import (
    FORMATS,
    expose_action,
    parse_elements,
    parse_launch_file,
    parse_launch_text,
)

__all__ = [
    "FORMATS",
    "SUBSTITUTIONS",
    "Element",
    "expose_action",
    "parse_elements",
    "parse_launch_file",
    "parse_launch_text",
    "parse_substitution",
]
