"""Base class of events."""


class Event:
    """Something that happened, or is to happen, in a launch."""

    name = "launch.Event"
