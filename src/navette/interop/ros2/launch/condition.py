"""Navette's ``launch.condition``."""

from navette.launch_files.launch.condition import (
    Condition,
)

__all__ = ["Condition"]
