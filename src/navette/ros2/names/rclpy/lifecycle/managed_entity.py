"""What a managed node manages."""

from navette.runtime.lifecycle import (
    ManagedEntity,
    SimpleManagedEntity,
    TransitionCallbackReturn,
)

__all__ = ["ManagedEntity", "SimpleManagedEntity", "TransitionCallbackReturn"]
