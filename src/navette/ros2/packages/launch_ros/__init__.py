"""ROS 2's ``launch_ros``: actions that launch nodes."""

from navette.ros2.packages.launch_ros import (
    actions,
    descriptions,
    parameter_descriptions,
    substitutions,
)

__all__ = ["actions", "descriptions", "parameter_descriptions", "substitutions"]
