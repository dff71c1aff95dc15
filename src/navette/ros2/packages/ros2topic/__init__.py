"""ROS 2's ``ros2topic``: what the command's programs share."""

from navette.ros2.packages.ros2topic import api

__all__ = ["api"]
