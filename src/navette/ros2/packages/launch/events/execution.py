"""Events about actions: done, timed, included."""

from collections.abc import Callable

from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.launch_description import LaunchDescription


class ExecutionComplete(Event):
    """An action has done all that it does."""

    name = "launch.events.ExecutionComplete"

    def __init__(self, *, action: Action) -> None:
        self.action = action


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


def matches_action(action: Action) -> Callable[[Action], bool]:
    """A matcher for events of exactly this action."""
    return lambda candidate: candidate is action
