"""ROS 2's ``launch.descriptions``."""

from navette.ros2.packages.launch.descriptions.executable import Executable

__all__ = ["Executable"]
