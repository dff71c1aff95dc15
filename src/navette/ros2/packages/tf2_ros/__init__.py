"""tf2_ros: buffer, listener and broadcasters on a node."""

from navette.msgs.geometry_msgs.msg import TransformStamped
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.ros2.packages.tf2_ros.buffer_client import BufferClient
from navette.ros2.packages.tf2_ros.buffer_server import BufferServer
from navette.runtime import Duration, Time
from navette.runtime.tf import (
    Buffer,
    BufferInterface,
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    StaticTransformBroadcaster,
    TimeoutException,
    TransformBroadcaster,
    TransformException,
    TransformListener,
)
from navette.runtime.tf import MessageCore as BufferCore
from navette.runtime.tf.registration import (
    ConvertRegistration,
    NotImplementedException,
    Stamped,
    TransformRegistration,
    TypeException,
    convert,
)
