"""Guard conditions."""

from navette.runtime.guard_condition import GuardCondition

__all__ = ["GuardCondition"]
