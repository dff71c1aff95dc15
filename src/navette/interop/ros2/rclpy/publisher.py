"""Publishers."""

from navette.runtime import CallbackGroup, Duration, QoSProfile
from navette.runtime.publisher import Publisher
from navette.runtime.qos_events import PublisherEventCallbacks
from navette.runtime.type_support import MsgT

__all__ = [
    "CallbackGroup",
    "Duration",
    "MsgT",
    "Publisher",
    "PublisherEventCallbacks",
    "QoSProfile",
]
