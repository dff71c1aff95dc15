"""Callback groups."""

from navette.runtime import (
    CallbackGroup,
    Client,
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
    Service,
    Subscription,
    Timer,
)
from navette.runtime.guard_condition import GuardCondition
from navette.runtime.waitable import Waitable

__all__ = [
    "CallbackGroup",
    "Client",
    "GuardCondition",
    "MutuallyExclusiveCallbackGroup",
    "ReentrantCallbackGroup",
    "Service",
    "Subscription",
    "Timer",
    "Waitable",
]
