"""The event that asks managed nodes for a transition."""

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
"""Number → name."""


class ChangeState(Event):
    """For the managed nodes that ``lifecycle_node_matcher`` picks by their actions."""

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
