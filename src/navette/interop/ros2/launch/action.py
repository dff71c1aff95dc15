"""Navette's ``launch.action``."""

from navette.launch_files.launch.action import (
    Action,
)

__all__ = ["Action"]
