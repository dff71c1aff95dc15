"""Navette's ``launch_xml.launch_description_sources``."""

from navette.ros2.packages.launch.launch_description_sources import (
    XMLLaunchDescriptionSource,
)

__all__ = ["XMLLaunchDescriptionSource"]
