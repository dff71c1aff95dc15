"""Navette's ``launch.launch_description``."""

from navette.launch_files.launch.launch_description import (
    LaunchDescription,
)

__all__ = ["LaunchDescription"]
