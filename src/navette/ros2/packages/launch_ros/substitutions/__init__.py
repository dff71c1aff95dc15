"""ROS 2's ``launch_ros.substitutions``."""

from navette.ros2.packages.launch_ros.substitutions.package import (
    ExecutableInPackage,
    FindPackage,
    FindPackagePrefix,
    FindPackageShare,
)
from navette.ros2.packages.launch_ros.substitutions.parameter import Parameter

__all__ = [
    "ExecutableInPackage",
    "FindPackage",
    "FindPackagePrefix",
    "FindPackageShare",
    "Parameter",
]
