"""ROS 2's ``launch_ros.actions``."""

from navette.ros2.packages.launch_ros.actions.composition import (
    ComposableNodeContainer,
    LoadComposableNodes,
    get_composable_node_load_request,
)
from navette.ros2.packages.launch_ros.actions.lifecycle_node import LifecycleNode
from navette.ros2.packages.launch_ros.actions.lifecycle_transition import (
    LifecycleTransition,
)
from navette.ros2.packages.launch_ros.actions.node import Node
from navette.ros2.packages.launch_ros.actions.ros_timer import RosTimer
from navette.ros2.packages.launch_ros.actions.scoped import (
    PushROSNamespace,
    PushRosNamespace,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetUseSimTime,
)

ROSTimer = RosTimer  # launch_ros has both names

__all__ = [
    "ComposableNodeContainer",
    "LifecycleNode",
    "LifecycleTransition",
    "LoadComposableNodes",
    "Node",
    "PushROSNamespace",
    "PushRosNamespace",
    "ROSTimer",
    "RosTimer",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetUseSimTime",
    "get_composable_node_load_request",
]
