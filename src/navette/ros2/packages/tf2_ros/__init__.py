"""tf2_ros: buffer, listener and broadcasters on a node."""

from navette.ros2.packages.tf2_ros.buffer_client import BufferClient
from navette.ros2.packages.tf2_ros.buffer_server import BufferServer
from navette.runtime.tf import (
    Buffer,
    BufferInterface,
    ConnectivityException,
    ConvertRegistration,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    NotImplementedException,
    Stamped,
    StaticTransformBroadcaster,
    TimeoutException,
    TransformBroadcaster,
    TransformException,
    TransformListener,
    TransformRegistration,
    TypeException,
    convert,
)
from navette.runtime.tf import MessageCore as BufferCore
