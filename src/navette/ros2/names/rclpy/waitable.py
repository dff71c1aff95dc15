"""What an executor can wait for, made by oneself."""

from navette.runtime import CallbackGroup
from navette.runtime.future import Future
from navette.runtime.wait_set import NumberOfEntities
from navette.runtime.waitable import Waitable

__all__ = [
    "CallbackGroup",
    "Future",
    "NumberOfEntities",
    "Waitable",
]
