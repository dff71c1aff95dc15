"""Navette's ``launch_ros.events.lifecycle``."""

from navette.launch_files.launch_ros.events.lifecycle import (
    ChangeState,
    StateTransition,
    matches_node_name,
)

__all__ = ["ChangeState", "StateTransition", "matches_node_name"]
