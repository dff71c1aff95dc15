"""ROS 2's ``launch.launch_description_sources`` (and those of launch_xml, _yaml)."""

from navette.ros2.packages.launch.errors import InvalidLaunchFileError
from navette.ros2.packages.launch.launch_description_sources.any_files import (
    AnyLaunchDescriptionSource,
    FrontendLaunchDescriptionSource,
    XMLLaunchDescriptionSource,
    YAMLLaunchDescriptionSource,
    get_launch_description_from_any_launch_file,
)
from navette.ros2.packages.launch.launch_description_sources.python_files import (
    InvalidPythonLaunchFileError,
    PythonLaunchDescriptionSource,
    get_launch_description_from_python_launch_file,
    load_python_launch_file_as_module,
)

__all__ = [
    "AnyLaunchDescriptionSource",
    "FrontendLaunchDescriptionSource",
    "InvalidLaunchFileError",
    "InvalidPythonLaunchFileError",
    "PythonLaunchDescriptionSource",
    "XMLLaunchDescriptionSource",
    "YAMLLaunchDescriptionSource",
    "get_launch_description_from_any_launch_file",
    "get_launch_description_from_python_launch_file",
    "load_python_launch_file_as_module",
]
