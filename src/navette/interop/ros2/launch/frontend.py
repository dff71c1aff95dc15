"""Navette's ``launch.frontend``."""

from navette.launch_files.launch.frontend import (
    FORMATS,
    SUBSTITUTIONS,
    Element,
    expose_action,
    parse_elements,
    parse_launch_file,
    parse_launch_text,
    parse_substitution,
)

__all__ = [
    "Element",
    "FORMATS",
    "SUBSTITUTIONS",
    "expose_action",
    "parse_elements",
    "parse_launch_file",
    "parse_launch_text",
    "parse_substitution",
]
