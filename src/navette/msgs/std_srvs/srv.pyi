# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from navette.msgs.base import Message
import navette.msgs.service_msgs.msg

class Empty_Request(Message):
    def __init__(self) -> None: ...

class Empty_Response(Message):
    def __init__(self) -> None: ...

class Empty_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[Empty_Request]
    response: list[Empty_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[Empty_Request] = ...,
        response: list[Empty_Response] = ...,
    ) -> None: ...

class Empty:
    Request = Empty_Request
    Response = Empty_Response
    Event = Empty_Event

class SetBool_Request(Message):
    data: bool
    def __init__(
        self,
        *,
        data: bool = ...,
    ) -> None: ...

class SetBool_Response(Message):
    success: bool
    message: str
    def __init__(
        self,
        *,
        success: bool = ...,
        message: str = ...,
    ) -> None: ...

class SetBool_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[SetBool_Request]
    response: list[SetBool_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[SetBool_Request] = ...,
        response: list[SetBool_Response] = ...,
    ) -> None: ...

class SetBool:
    Request = SetBool_Request
    Response = SetBool_Response
    Event = SetBool_Event

class Trigger_Request(Message):
    def __init__(self) -> None: ...

class Trigger_Response(Message):
    success: bool
    message: str
    def __init__(
        self,
        *,
        success: bool = ...,
        message: str = ...,
    ) -> None: ...

class Trigger_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[Trigger_Request]
    response: list[Trigger_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[Trigger_Request] = ...,
        response: list[Trigger_Response] = ...,
    ) -> None: ...

class Trigger:
    Request = Trigger_Request
    Response = Trigger_Response
    Event = Trigger_Event
