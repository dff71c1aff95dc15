"""ROS 2's ``ros2cli``: the nodes of command-line tools."""

from navette.ros2.packages.ros2cli import node

__all__ = ["node"]
