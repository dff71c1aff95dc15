"""Navette's ``launch_yaml.launch_description_sources``."""

from navette.launch_files.launch.launch_description_sources import (
    YAMLLaunchDescriptionSource,
)

__all__ = ["YAMLLaunchDescriptionSource"]
