"""Navette's ``launch.launch_description_entity``."""

from navette.launch_files.launch.launch_description_entity import (
    LaunchDescriptionEntity,
)

__all__ = ["LaunchDescriptionEntity"]
