"""Transforms over time: buffer, listener, broadcasters, with tf2's names."""

from navette.runtime.tf.broadcasters import (
    StaticTransformBroadcaster,
    TransformBroadcaster,
)
from navette.runtime.tf.buffer import Buffer
from navette.runtime.tf.do_transform import (
    do_transform_point,
    do_transform_pose,
    do_transform_pose_stamped,
    do_transform_vector3,
)
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
    "do_transform_point",
    "do_transform_pose",
    "do_transform_pose_stamped",
    "do_transform_vector3",
]
