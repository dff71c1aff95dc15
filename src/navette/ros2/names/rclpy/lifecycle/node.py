"""Managed nodes."""

from navette.runtime import CallbackGroup, Context, Node, Parameter, QoSProfile, Service
from navette.runtime.lifecycle import (
    LifecycleNode,
    LifecycleNodeMixin,
    LifecyclePublisher,
    LifecycleState,
    TransitionCallbackReturn,
)
from navette.runtime.qos_events import PublisherEventCallbacks
from navette.runtime.qos_overriding_options import QoSOverridingOptions

__all__ = [
    "CallbackGroup",
    "Context",
    "LifecycleNode",
    "LifecycleNodeMixin",
    "LifecyclePublisher",
    "LifecycleState",
    "Node",
    "Parameter",
    "PublisherEventCallbacks",
    "QoSOverridingOptions",
    "QoSProfile",
    "Service",
    "TransitionCallbackReturn",
]
