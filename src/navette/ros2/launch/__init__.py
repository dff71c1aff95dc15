"""Run launch files: ``navette launch``."""

from navette.ros2.launch.arguments import parse_launch_arguments
from navette.ros2.launch.session import launch, show_arguments

__all__ = ["launch", "parse_launch_arguments", "show_arguments"]
