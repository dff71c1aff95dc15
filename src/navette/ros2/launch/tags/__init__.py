"""Tags of XML and YAML launch files."""

from navette.ros2.launch.tags import core, ros

__all__ = ["core", "ros"]
