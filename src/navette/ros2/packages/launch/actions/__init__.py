"""ROS 2's ``launch.actions``."""

from navette.ros2.packages.launch.actions.arguments import (
    DeclareLaunchArgument,
    PopLaunchConfigurations,
    PushLaunchConfigurations,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
    UnsetLaunchConfiguration,
)
from navette.ros2.packages.launch.actions.environment import (
    AppendEnvironmentVariable,
    PopEnvironment,
    PushEnvironment,
    ResetEnvironment,
    SetEnvironmentVariable,
    UnsetEnvironmentVariable,
)
from navette.ros2.packages.launch.actions.events import (
    EmitEvent,
    RegisterEventHandler,
    Shutdown,
    UnregisterEventHandler,
)
from navette.ros2.packages.launch.actions.execute_process import (
    ExecuteLocal,
    ExecuteProcess,
)
from navette.ros2.packages.launch.actions.for_loop import ForEach, ForLoop
from navette.ros2.packages.launch.actions.group_action import GroupAction
from navette.ros2.packages.launch.actions.include_launch_description import (
    IncludeLaunchDescription,
)
from navette.ros2.packages.launch.actions.log_info import (
    Log,
    LogDebug,
    LogError,
    LogInfo,
    LogWarning,
)
from navette.ros2.packages.launch.actions.opaque_coroutine import OpaqueCoroutine
from navette.ros2.packages.launch.actions.opaque_function import OpaqueFunction
from navette.ros2.packages.launch.actions.timer_action import TimerAction

__all__ = [
    "AppendEnvironmentVariable",
    "DeclareLaunchArgument",
    "EmitEvent",
    "ExecuteLocal",
    "ExecuteProcess",
    "ForEach",
    "ForLoop",
    "GroupAction",
    "IncludeLaunchDescription",
    "Log",
    "LogDebug",
    "LogError",
    "LogInfo",
    "LogWarning",
    "OpaqueCoroutine",
    "OpaqueFunction",
    "PopEnvironment",
    "PopLaunchConfigurations",
    "PushEnvironment",
    "PushLaunchConfigurations",
    "RegisterEventHandler",
    "ResetEnvironment",
    "ResetLaunchConfigurations",
    "SetEnvironmentVariable",
    "SetLaunchConfiguration",
    "Shutdown",
    "TimerAction",
    "UnregisterEventHandler",
    "UnsetEnvironmentVariable",
    "UnsetLaunchConfiguration",
]
