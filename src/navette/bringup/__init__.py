"""Runs launch files: ``navette launch``."""

from navette.bringup.arguments import parse_launch_arguments
from navette.bringup.session import launch, show_arguments

__all__ = ["launch", "parse_launch_arguments", "show_arguments"]
