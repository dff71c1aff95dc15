# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from navette.msgs.base import Message
import navette.msgs.builtin_interfaces.msg
import navette.msgs.service_msgs.msg

class GetRate_Request(Message):
    def __init__(self) -> None: ...

class GetRate_Response(Message):
    rate: float
    def __init__(
        self,
        *,
        rate: float = ...,
    ) -> None: ...

class GetRate_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[GetRate_Request]
    response: list[GetRate_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[GetRate_Request] = ...,
        response: list[GetRate_Response] = ...,
    ) -> None: ...

class GetRate:
    Request = GetRate_Request
    Response = GetRate_Response
    Event = GetRate_Event

class IsPaused_Request(Message):
    def __init__(self) -> None: ...

class IsPaused_Response(Message):
    paused: bool
    def __init__(
        self,
        *,
        paused: bool = ...,
    ) -> None: ...

class IsPaused_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[IsPaused_Request]
    response: list[IsPaused_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[IsPaused_Request] = ...,
        response: list[IsPaused_Response] = ...,
    ) -> None: ...

class IsPaused:
    Request = IsPaused_Request
    Response = IsPaused_Response
    Event = IsPaused_Event

class Pause_Request(Message):
    def __init__(self) -> None: ...

class Pause_Response(Message):
    def __init__(self) -> None: ...

class Pause_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[Pause_Request]
    response: list[Pause_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[Pause_Request] = ...,
        response: list[Pause_Response] = ...,
    ) -> None: ...

class Pause:
    Request = Pause_Request
    Response = Pause_Response
    Event = Pause_Event

class PlayNext_Request(Message):
    def __init__(self) -> None: ...

class PlayNext_Response(Message):
    success: bool
    def __init__(
        self,
        *,
        success: bool = ...,
    ) -> None: ...

class PlayNext_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[PlayNext_Request]
    response: list[PlayNext_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[PlayNext_Request] = ...,
        response: list[PlayNext_Response] = ...,
    ) -> None: ...

class PlayNext:
    Request = PlayNext_Request
    Response = PlayNext_Response
    Event = PlayNext_Event

class Resume_Request(Message):
    def __init__(self) -> None: ...

class Resume_Response(Message):
    def __init__(self) -> None: ...

class Resume_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[Resume_Request]
    response: list[Resume_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[Resume_Request] = ...,
        response: list[Resume_Response] = ...,
    ) -> None: ...

class Resume:
    Request = Resume_Request
    Response = Resume_Response
    Event = Resume_Event

class Seek_Request(Message):
    time: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        time: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class Seek_Response(Message):
    success: bool
    def __init__(
        self,
        *,
        success: bool = ...,
    ) -> None: ...

class Seek_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[Seek_Request]
    response: list[Seek_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[Seek_Request] = ...,
        response: list[Seek_Response] = ...,
    ) -> None: ...

class Seek:
    Request = Seek_Request
    Response = Seek_Response
    Event = Seek_Event

class SetRate_Request(Message):
    rate: float
    def __init__(
        self,
        *,
        rate: float = ...,
    ) -> None: ...

class SetRate_Response(Message):
    success: bool
    def __init__(
        self,
        *,
        success: bool = ...,
    ) -> None: ...

class SetRate_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[SetRate_Request]
    response: list[SetRate_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[SetRate_Request] = ...,
        response: list[SetRate_Response] = ...,
    ) -> None: ...

class SetRate:
    Request = SetRate_Request
    Response = SetRate_Response
    Event = SetRate_Event

class Stop_Request(Message):
    def __init__(self) -> None: ...

class Stop_Response(Message):
    def __init__(self) -> None: ...

class Stop_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[Stop_Request]
    response: list[Stop_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[Stop_Request] = ...,
        response: list[Stop_Response] = ...,
    ) -> None: ...

class Stop:
    Request = Stop_Request
    Response = Stop_Response
    Event = Stop_Event

class TogglePaused_Request(Message):
    def __init__(self) -> None: ...

class TogglePaused_Response(Message):
    def __init__(self) -> None: ...

class TogglePaused_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[TogglePaused_Request]
    response: list[TogglePaused_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[TogglePaused_Request] = ...,
        response: list[TogglePaused_Response] = ...,
    ) -> None: ...

class TogglePaused:
    Request = TogglePaused_Request
    Response = TogglePaused_Response
    Event = TogglePaused_Event
