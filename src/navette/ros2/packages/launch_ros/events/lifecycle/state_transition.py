"""Event of a state transition of a lifecycle node."""

from typing import Any

from navette.ros2.packages.launch import Event


class StateTransition(Event):
    """A lifecycle node changed its state.

    ``action`` is the LifecycleNode, ``msg`` its TransitionEvent.
    """

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(self, *, action: Any, msg: Any) -> None:
        self.action = action
        self.msg = msg

    @property
    def timestamp(self) -> int:
        return int(self.msg.timestamp)

    @property
    def transition(self) -> str:
        return str(self.msg.transition.label)

    @property
    def start_state(self) -> str:
        return str(self.msg.start_state.label)

    @property
    def goal_state(self) -> str:
        return str(self.msg.goal_state.label)
