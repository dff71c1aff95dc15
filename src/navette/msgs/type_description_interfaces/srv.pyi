# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from navette.msgs.base import Message
import navette.msgs.service_msgs.msg
import navette.msgs.type_description_interfaces.msg

class GetTypeDescription_Request(Message):
    type_name: str
    type_hash: str
    include_type_sources: bool
    def __init__(
        self,
        *,
        type_name: str = ...,
        type_hash: str = ...,
        include_type_sources: bool = ...,
    ) -> None: ...

class GetTypeDescription_Response(Message):
    successful: bool
    failure_reason: str
    type_description: navette.msgs.type_description_interfaces.msg.TypeDescription
    type_sources: list[navette.msgs.type_description_interfaces.msg.TypeSource]
    extra_information: list[navette.msgs.type_description_interfaces.msg.KeyValue]
    def __init__(
        self,
        *,
        successful: bool = ...,
        failure_reason: str = ...,
        type_description: navette.msgs.type_description_interfaces.msg.TypeDescription = ...,
        type_sources: list[navette.msgs.type_description_interfaces.msg.TypeSource] = ...,
        extra_information: list[navette.msgs.type_description_interfaces.msg.KeyValue] = ...,
    ) -> None: ...

class GetTypeDescription_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[GetTypeDescription_Request]
    response: list[GetTypeDescription_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[GetTypeDescription_Request] = ...,
        response: list[GetTypeDescription_Response] = ...,
    ) -> None: ...

class GetTypeDescription:
    Request = GetTypeDescription_Request
    Response = GetTypeDescription_Response
    Event = GetTypeDescription_Event
