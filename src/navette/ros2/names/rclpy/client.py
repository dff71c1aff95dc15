"""Clients of services."""

from navette.runtime import CallbackGroup, Context
from navette.runtime.client import Client
from navette.runtime.future import Future
from navette.runtime.qos import QoSProfile
from navette.runtime.ros_clock import Clock
from navette.runtime.service_introspection import ServiceIntrospectionState
from navette.runtime.type_support import SrvEventT, SrvRequestT, SrvResponseT
from navette.runtime.type_support import SrvRequestT as SrvTypeRequest
from navette.runtime.type_support import SrvResponseT as SrvTypeResponse
from navette.runtime.type_support import SrvT as SrvType

__all__ = [
    "CallbackGroup",
    "Client",
    "Clock",
    "Context",
    "Future",
    "QoSProfile",
    "ServiceIntrospectionState",
    "SrvEventT",
    "SrvRequestT",
    "SrvResponseT",
    "SrvType",
    "SrvTypeRequest",
    "SrvTypeResponse",
]
