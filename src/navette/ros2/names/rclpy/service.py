"""Services."""

from navette.runtime import CallbackGroup
from navette.runtime.qos import QoSProfile
from navette.runtime.ros_clock import Clock
from navette.runtime.service import Service
from navette.runtime.service_introspection import ServiceIntrospectionState
from navette.runtime.type_support import SrvEventT, SrvRequestT, SrvResponseT
from navette.runtime.type_support import SrvRequestT as SrvTypeRequest
from navette.runtime.type_support import SrvResponseT as SrvTypeResponse
from navette.runtime.type_support import SrvT as SrvType

__all__ = [
    "CallbackGroup",
    "Clock",
    "QoSProfile",
    "Service",
    "ServiceIntrospectionState",
    "SrvEventT",
    "SrvRequestT",
    "SrvResponseT",
    "SrvType",
    "SrvTypeRequest",
    "SrvTypeResponse",
]
