"""Navette's ``launch.event_handler``."""

from navette.launch_files.launch.event_handler import (
    EventHandler,
)

__all__ = ["EventHandler"]
