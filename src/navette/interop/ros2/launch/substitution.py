"""Navette's ``launch.substitution``."""

from navette.launch_files.launch.substitution import (
    Substitution,
)

__all__ = ["Substitution"]
