"""Futures and tasks."""

from navette.runtime.future import Future, Task

__all__ = ["Future", "Task"]
