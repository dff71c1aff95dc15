"""Subscriptions."""

from navette.runtime import CallbackGroup, QoSProfile
from navette.runtime.content_filter import ContentFilterOptions
from navette.runtime.qos_events import SubscriptionEventCallbacks
from navette.runtime.subscription import MessageInfo, Subscription
from navette.runtime.type_support import MsgT
from navette.runtime.type_support import MsgT as MsgType

__all__ = [
    "CallbackGroup",
    "ContentFilterOptions",
    "MessageInfo",
    "MsgT",
    "MsgType",
    "QoSProfile",
    "Subscription",
    "SubscriptionEventCallbacks",
]
