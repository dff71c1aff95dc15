"""ROS 2's ``launch_ros.events``."""

from navette.ros2.packages.launch_ros.events import lifecycle
from navette.ros2.packages.launch_ros.events.matchers import matches_node_name

__all__ = ["lifecycle", "matches_node_name"]
