"""tf2_ros: buffer, listener and broadcasters on a node."""

from navette.ros2.packages.tf2_py import (
    BufferCore,
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)
from navette.ros2.packages.tf2_ros.buffer import Buffer
from navette.ros2.packages.tf2_ros.buffer_client import BufferClient
from navette.ros2.packages.tf2_ros.buffer_interface import (
    BufferInterface,
    ConvertRegistration,
    NotImplementedException,
    Stamped,
    TransformRegistration,
    TypeException,
    convert,
)
from navette.ros2.packages.tf2_ros.buffer_server import BufferServer
from navette.ros2.packages.tf2_ros.static_transform_broadcaster import (
    StaticTransformBroadcaster,
)
from navette.ros2.packages.tf2_ros.transform_broadcaster import TransformBroadcaster
from navette.ros2.packages.tf2_ros.transform_listener import TransformListener

__all__ = [
    "Buffer",
    "BufferClient",
    "BufferServer",
    "BufferCore",
    "BufferInterface",
    "ConnectivityException",
    "ConvertRegistration",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "NotImplementedException",
    "Stamped",
    "StaticTransformBroadcaster",
    "TimeoutException",
    "TransformBroadcaster",
    "TransformException",
    "TransformListener",
    "TransformRegistration",
    "TypeException",
    "convert",
]
