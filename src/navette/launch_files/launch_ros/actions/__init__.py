"""ROS 2's ``launch_ros.actions``."""

from navette.launch_files.launch_ros.actions.composition import (
    ComposableNodeContainer,
    LoadComposableNodes,
)
from navette.launch_files.launch_ros.actions.lifecycle_node import LifecycleNode
from navette.launch_files.launch_ros.actions.node import Node
from navette.launch_files.launch_ros.actions.scoped import (
    PushROSNamespace,
    PushRosNamespace,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetUseSimTime,
)

__all__ = [
    "ComposableNodeContainer",
    "LifecycleNode",
    "LoadComposableNodes",
    "Node",
    "PushROSNamespace",
    "PushRosNamespace",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetUseSimTime",
]
