"""Subscriptions."""

from navette.runtime.subscription import MessageInfo, Subscription

__all__ = ["MessageInfo", "Subscription"]
