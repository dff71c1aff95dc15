"""ROS 2's ``launch_ros.events.lifecycle``."""

from navette.ros2.packages.launch_ros.events.lifecycle.change_state import ChangeState
from navette.ros2.packages.launch_ros.events.lifecycle.state_transition import (
    StateTransition,
)
from navette.ros2.packages.launch_ros.events.matchers import matches_node_name

__all__ = ["ChangeState", "StateTransition", "matches_node_name"]
