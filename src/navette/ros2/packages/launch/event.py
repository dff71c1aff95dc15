"""Events: what happened, or what is to happen, in a launch."""


class Event:
    """Base of all events."""

    name = "launch.Event"
