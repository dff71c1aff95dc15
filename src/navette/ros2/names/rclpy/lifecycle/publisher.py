"""Publishers that a managed node switches."""

from navette.runtime import CallbackGroup, Publisher, QoSProfile
from navette.runtime.lifecycle import LifecyclePublisher
from navette.runtime.qos_events import PublisherEventCallbacks

__all__ = [
    "CallbackGroup",
    "LifecyclePublisher",
    "Publisher",
    "PublisherEventCallbacks",
    "QoSProfile",
]
