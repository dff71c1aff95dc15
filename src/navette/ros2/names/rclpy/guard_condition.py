"""Guard conditions."""

from navette.runtime import CallbackGroup, Context, get_default_context
from navette.runtime.guard_condition import GuardCondition

__all__ = [
    "CallbackGroup",
    "Context",
    "GuardCondition",
    "get_default_context",
]
