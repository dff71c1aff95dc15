"""Navette's ``launch_ros.events``."""

from navette.launch_files.launch_ros.events import matches_node_name

__all__ = ["matches_node_name"]
