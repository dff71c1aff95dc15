"""ROS 2's ``launch_ros.substitutions``."""

from navette.launch_files.launch_ros.substitutions.package import (
    ExecutableInPackage,
    FindPackage,
    FindPackagePrefix,
    FindPackageShare,
)
from navette.launch_files.launch_ros.substitutions.parameter import Parameter

__all__ = [
    "ExecutableInPackage",
    "FindPackage",
    "FindPackagePrefix",
    "FindPackageShare",
    "Parameter",
]
