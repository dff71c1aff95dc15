"""Navette's ``launch.launch_context``."""

from navette.launch_files.launch.launch_context import (
    LaunchContext,
)

__all__ = ["LaunchContext"]
