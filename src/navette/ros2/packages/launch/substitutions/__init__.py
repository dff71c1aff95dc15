"""ROS 2's ``launch.substitutions``."""

from navette.ros2.packages.launch.errors import SubstitutionFailure
from navette.ros2.packages.launch.substitution import TextSubstitution
from navette.ros2.packages.launch.substitutions.configuration import (
    AnonName,
    EnvironmentVariable,
    LaunchConfiguration,
    LaunchLogDir,
    LocalSubstitution,
    ThisLaunchFile,
    ThisLaunchFileDir,
)
from navette.ros2.packages.launch.substitutions.files import (
    Command,
    FileContent,
    FindExecutable,
    PathJoinSubstitution,
    PathSubstitution,
)
from navette.ros2.packages.launch.substitutions.logic import (
    AllSubstitution,
    AndSubstitution,
    AnySubstitution,
    EqualsSubstitution,
    IfElseSubstitution,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
)
from navette.ros2.packages.launch.substitutions.python_expression import (
    PythonExpression,
)

__all__ = [
    "AllSubstitution",
    "AndSubstitution",
    "AnonName",
    "AnySubstitution",
    "Command",
    "EnvironmentVariable",
    "EqualsSubstitution",
    "FileContent",
    "FindExecutable",
    "IfElseSubstitution",
    "LaunchConfiguration",
    "LaunchLogDir",
    "LocalSubstitution",
    "NotEqualsSubstitution",
    "NotSubstitution",
    "OrSubstitution",
    "PathJoinSubstitution",
    "PathSubstitution",
    "PythonExpression",
    "SubstitutionFailure",
    "TextSubstitution",
    "ThisLaunchFile",
    "ThisLaunchFileDir",
]
