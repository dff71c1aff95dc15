"""ROS 2's ``launch_ros.event_handlers``."""

from navette.launch_files.launch_ros.event_handlers.on_state_transition import (
    OnStateTransition,
)

__all__ = ["OnStateTransition"]
