"""Navette's ``launch_ros.events.matchers``."""

from navette.launch_files.launch_ros.events.matchers import matches_node_name

__all__ = ["matches_node_name"]
