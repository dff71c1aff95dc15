"""Managed nodes."""

from navette.runtime.lifecycle import (
    LifecycleNode,
    LifecycleNodeMixin,
    LifecycleState,
    TransitionCallbackReturn,
)

__all__ = [
    "LifecycleNode",
    "LifecycleNodeMixin",
    "LifecycleState",
    "TransitionCallbackReturn",
]
