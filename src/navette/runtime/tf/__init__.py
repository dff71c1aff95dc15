"""tf2: buffer, listener and broadcasters of transforms over time."""

import navette.runtime.tf.do_transform  # registers the geometry types
from navette.runtime.tf.broadcasters import (
    StaticTransformBroadcaster,
    TransformBroadcaster,
)
from navette.runtime.tf.buffer import Buffer
from navette.runtime.tf.buffer_interface import BufferInterface
from navette.runtime.tf.exceptions import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)
from navette.runtime.tf.listener import TransformListener
from navette.runtime.tf.message_core import MessageCore

__all__ = [
    "Buffer",
    "BufferInterface",
    "MessageCore",
    "StaticTransformBroadcaster",
    "TransformBroadcaster",
    "TransformListener",
    "ConnectivityException",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "TimeoutException",
    "TransformException",
]
