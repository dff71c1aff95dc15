"""What each tag of an XML or YAML launch file stands for."""

from navette.ros2.launch.tags import core, ros

__all__ = ["core", "ros"]
