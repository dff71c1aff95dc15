"""Navette's ``launch.event``."""

from navette.launch_files.launch.event import (
    Event,
)

__all__ = ["Event"]
