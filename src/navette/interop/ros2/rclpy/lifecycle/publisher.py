"""Publishers that a managed node switches."""

from navette.runtime.lifecycle import LifecyclePublisher

__all__ = ["LifecyclePublisher"]
