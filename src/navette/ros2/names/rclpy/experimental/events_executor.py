"""The executor driven by events, which is what every executor is here."""

from navette.runtime.executor import EventsExecutor

__all__ = [
    "EventsExecutor",
]
