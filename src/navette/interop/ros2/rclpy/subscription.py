"""Subscriptions."""

from navette.runtime import CallbackGroup, QoSProfile
from navette.runtime.qos_events import SubscriptionEventCallbacks
from navette.runtime.subscription import MessageInfo, Subscription
from navette.runtime.type_support import MsgT

__all__ = [
    "CallbackGroup",
    "MessageInfo",
    "MsgT",
    "QoSProfile",
    "Subscription",
    "SubscriptionEventCallbacks",
]
