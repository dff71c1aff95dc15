"""Transforms over time: buffer, listener, broadcasters, with tf2's names."""

from navette.runtime.tf.broadcasters import (
    StaticTransformBroadcaster,
    TransformBroadcaster,
)
from navette.runtime.tf.buffer import Buffer
from navette.runtime.tf.exceptions import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TransformException,
)
from navette.runtime.tf.listener import TransformListener

__all__ = [
    "Buffer",
    "ConnectivityException",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "StaticTransformBroadcaster",
    "TransformBroadcaster",
    "TransformException",
    "TransformListener",
]
