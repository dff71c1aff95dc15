"""Executors that ROS 2 still tries out; one loop runs them all here."""

from navette.runtime.executor import EventsExecutor

__all__ = [
    "EventsExecutor",
]
