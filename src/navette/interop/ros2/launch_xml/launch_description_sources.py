"""Navette's ``launch_xml.launch_description_sources``."""

from navette.launch_files.launch.launch_description_sources import (
    XMLLaunchDescriptionSource,
)

__all__ = ["XMLLaunchDescriptionSource"]
