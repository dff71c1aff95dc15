"""Futures and tasks."""

from navette.runtime import Executor
from navette.runtime.future import Future, Task

__all__ = [
    "Executor",
    "Future",
    "Task",
]
