"""Navette's ``launch.launch_description_source``."""

from navette.launch_files.launch.launch_description_source import (
    LaunchDescriptionSource,
)

__all__ = ["LaunchDescriptionSource"]
