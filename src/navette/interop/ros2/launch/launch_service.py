"""Navette's ``launch.launch_service``."""

from navette.launch_files.launch.launch_service import (
    LaunchService,
)

__all__ = ["LaunchService"]
