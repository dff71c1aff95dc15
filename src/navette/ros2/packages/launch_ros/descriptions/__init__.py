"""ROS 2's ``launch_ros.descriptions``."""

from navette.ros2.packages.launch_ros.descriptions.composable_node import ComposableNode
from navette.ros2.packages.launch_ros.parameter_descriptions import (
    Parameter,
    ParameterFile,
    ParameterValue,
)

__all__ = ["ComposableNode", "Parameter", "ParameterFile", "ParameterValue"]
