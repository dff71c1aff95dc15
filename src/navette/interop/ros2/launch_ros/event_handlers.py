"""Navette's ``launch_ros.event_handlers``."""

from navette.launch_files.launch_ros.event_handlers import OnStateTransition

__all__ = ["OnStateTransition"]
