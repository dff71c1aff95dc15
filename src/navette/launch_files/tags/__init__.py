"""What each tag of an XML or YAML launch file stands for."""

from navette.launch_files.tags import core, ros

__all__ = ["core", "ros"]
