"""tf2: buffer, listener and broadcasters of transforms over time."""

from navette.runtime.tf.broadcasters import (
    StaticTransformBroadcaster,
    TransformBroadcaster,
)
from navette.runtime.tf.buffer import Buffer
from navette.runtime.tf.buffer_interface import BufferInterface
from navette.runtime.tf.do_transform import (
    do_transform_point,
    do_transform_polygon_stamped,
    do_transform_pose,
    do_transform_pose_stamped,
    do_transform_pose_with_covariance_stamped,
    do_transform_vector3,
    do_transform_wrench_stamped,
    from_msg_msg,
    to_msg_msg,
    transform_covariance,
)
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
from navette.runtime.tf.registration import (
    ConvertRegistration,
    NotImplementedException,
    Stamped,
    TransformRegistration,
    TypeException,
    convert,
)

__all__ = [
    # buffers and topics
    "Buffer",
    "BufferInterface",
    "MessageCore",
    "StaticTransformBroadcaster",
    "TransformBroadcaster",
    "TransformListener",
    # messages in other frames
    "ConvertRegistration",
    "Stamped",
    "TransformRegistration",
    "convert",
    "do_transform_point",
    "do_transform_polygon_stamped",
    "do_transform_pose",
    "do_transform_pose_stamped",
    "do_transform_pose_with_covariance_stamped",
    "do_transform_vector3",
    "do_transform_wrench_stamped",
    "from_msg_msg",
    "to_msg_msg",
    "transform_covariance",
    # errors
    "ConnectivityException",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "NotImplementedException",
    "TimeoutException",
    "TransformException",
    "TypeException",
]
