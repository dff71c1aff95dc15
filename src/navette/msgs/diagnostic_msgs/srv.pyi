# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from navette.msgs.base import Message
import navette.msgs.diagnostic_msgs.msg
import navette.msgs.service_msgs.msg

class AddDiagnostics_Request(Message):
    load_namespace: str
    def __init__(
        self,
        *,
        load_namespace: str = ...,
    ) -> None: ...

class AddDiagnostics_Response(Message):
    success: bool
    message: str
    def __init__(
        self,
        *,
        success: bool = ...,
        message: str = ...,
    ) -> None: ...

class AddDiagnostics_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[AddDiagnostics_Request]
    response: list[AddDiagnostics_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[AddDiagnostics_Request] = ...,
        response: list[AddDiagnostics_Response] = ...,
    ) -> None: ...

class AddDiagnostics:
    Request = AddDiagnostics_Request
    Response = AddDiagnostics_Response
    Event = AddDiagnostics_Event

class SelfTest_Request(Message):
    def __init__(self) -> None: ...

class SelfTest_Response(Message):
    id: str
    passed: bytes
    status: list[navette.msgs.diagnostic_msgs.msg.DiagnosticStatus]
    def __init__(
        self,
        *,
        id: str = ...,
        passed: bytes = ...,
        status: list[navette.msgs.diagnostic_msgs.msg.DiagnosticStatus] = ...,
    ) -> None: ...

class SelfTest_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[SelfTest_Request]
    response: list[SelfTest_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[SelfTest_Request] = ...,
        response: list[SelfTest_Response] = ...,
    ) -> None: ...

class SelfTest:
    Request = SelfTest_Request
    Response = SelfTest_Response
    Event = SelfTest_Event
