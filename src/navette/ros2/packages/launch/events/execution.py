"""Events about actions and about the launch."""

from collections.abc import Callable

from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.launch_description import LaunchDescription


class TimerEvent(Event):
    """The period of a timer is over."""

    name = "launch.events.TimerEvent"

    def __init__(self, *, timer_action: Action) -> None:
        self.timer_action = timer_action


class IncludeLaunchDescription(Event):
    """A launch description is to be visited."""

    name = "launch.events.IncludeLaunchDescription"

    def __init__(self, launch_description: LaunchDescription) -> None:
        self.launch_description = launch_description


class Shutdown(Event):
    """The launch is to end, or is ending."""

    name = "launch.events.Shutdown"

    def __init__(
        self, *, reason: str = "reason not given", due_to_sigint: bool = False
    ) -> None:
        self.reason = reason
        self.due_to_sigint = due_to_sigint


def matches_action(action: Action) -> Callable[[Action], bool]:
    """Return a matcher of events of this action."""
    return lambda candidate: candidate is action
