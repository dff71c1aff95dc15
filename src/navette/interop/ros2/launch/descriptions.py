"""Navette's ``launch.descriptions``."""

from navette.launch_files.launch.descriptions import (
    Executable,
)

__all__ = ["Executable"]
