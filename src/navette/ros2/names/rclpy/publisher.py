"""Publishers."""

from navette.runtime import CallbackGroup, Duration, QoSProfile
from navette.runtime.publisher import Publisher
from navette.runtime.qos_events import PublisherEventCallbacks
from navette.runtime.type_support import MsgT
from navette.runtime.type_support import MsgT as MsgType

__all__ = [
    "CallbackGroup",
    "Duration",
    "MsgT",
    "MsgType",
    "Publisher",
    "PublisherEventCallbacks",
    "QoSProfile",
]
