"""Base class of events, and the event of every action."""

from typing import Any


class Event:
    """Something that happened, or is to happen, in a launch."""

    name = "launch.Event"


class ExecutionComplete(Event):
    """An action is complete."""

    name = "launch.events.ExecutionComplete"

    def __init__(self, *, action: Any) -> None:
        self.action = action
