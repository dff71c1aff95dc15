"""Event that requests a transition of lifecycle nodes."""

from collections.abc import Callable
from typing import Any

from navette.msgs.lifecycle_msgs.msg import Transition
from navette.ros2.packages.launch import Event
from navette.ros2.packages.launch.errors import InvalidLaunchValueError

TRANSITIONS = {
    getattr(Transition, name): name
    for name in (
        "TRANSITION_CREATE",
        "TRANSITION_CONFIGURE",
        "TRANSITION_CLEANUP",
        "TRANSITION_ACTIVATE",
        "TRANSITION_DEACTIVATE",
        "TRANSITION_UNCONFIGURED_SHUTDOWN",
        "TRANSITION_INACTIVE_SHUTDOWN",
        "TRANSITION_ACTIVE_SHUTDOWN",
        "TRANSITION_DESTROY",
    )
}
"""Transition id → name."""


class ChangeState(Event):
    """Request to the lifecycle nodes whose actions the matcher selects."""

    name = "launch_ros.events.lifecycle.ChangeState"
    valid_transitions = TRANSITIONS

    def __init__(
        self, *, lifecycle_node_matcher: Callable[[Any], bool], transition_id: int
    ) -> None:
        if transition_id not in TRANSITIONS:
            known = ", ".join(f"{name}: {i}" for i, name in TRANSITIONS.items())
            raise InvalidLaunchValueError(
                f"ChangeState: transition_id {transition_id!r}; known: {known}"
            )
        self.lifecycle_node_matcher = lifecycle_node_matcher
        self.transition_id = transition_id
