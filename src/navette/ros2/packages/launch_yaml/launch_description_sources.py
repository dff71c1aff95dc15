"""Navette's ``launch_yaml.launch_description_sources``."""

from navette.ros2.packages.launch.launch_description_sources import (
    YAMLLaunchDescriptionSource,
)

__all__ = ["YAMLLaunchDescriptionSource"]
