"""ROS 2's ``launch_ros.event_handlers``."""

from navette.ros2.packages.launch_ros.event_handlers.on_state_transition import (
    OnStateTransition,
)

__all__ = ["OnStateTransition"]
