"""ROS 2's ``launch.descriptions``."""

from navette.launch_files.launch.descriptions.executable import Executable

__all__ = ["Executable"]
