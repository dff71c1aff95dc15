"""What an executor can wait for, made by oneself."""

from navette.runtime.waitable import Waitable

__all__ = ["Waitable"]
