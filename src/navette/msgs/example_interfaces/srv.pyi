# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from navette.msgs.base import Message
import navette.msgs.service_msgs.msg

class AddTwoInts_Request(Message):
    a: int
    b: int
    def __init__(
        self,
        *,
        a: int = ...,
        b: int = ...,
    ) -> None: ...

class AddTwoInts_Response(Message):
    sum: int
    def __init__(
        self,
        *,
        sum: int = ...,
    ) -> None: ...

class AddTwoInts_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[AddTwoInts_Request]
    response: list[AddTwoInts_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[AddTwoInts_Request] = ...,
        response: list[AddTwoInts_Response] = ...,
    ) -> None: ...

class AddTwoInts:
    Request = AddTwoInts_Request
    Response = AddTwoInts_Response
    Event = AddTwoInts_Event

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
