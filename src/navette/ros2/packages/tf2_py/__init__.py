"""tf2_py: the transform buffer without a node, and tf2's exceptions."""

from navette.runtime.tf import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)
from navette.runtime.tf import MessageCore as BufferCore
