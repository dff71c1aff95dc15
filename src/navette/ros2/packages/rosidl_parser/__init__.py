"""ROS 2's ``rosidl_parser``, as far as programs use it: the types of fields."""

from navette.ros2.packages.rosidl_parser import definition

__all__ = ["definition"]
