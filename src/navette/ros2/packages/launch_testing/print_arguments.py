"""List of the arguments of a test description."""

import sys
from typing import Any

from navette.ros2.packages.launch.actions.arguments import describe_arguments


def print_arguments_of_launch_description(*, launch_description: Any) -> None:
    """Print the names, descriptions and defaults of the arguments."""
    declared = launch_description.get_launch_arguments()
    sys.stdout.write(f"{describe_arguments(declared)}\n")
