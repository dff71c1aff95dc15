# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from navette.msgs.base import Message
import navette.msgs.service_msgs.msg

class FrameGraph_Request(Message):
    def __init__(self) -> None: ...

class FrameGraph_Response(Message):
    frame_yaml: str
    def __init__(
        self,
        *,
        frame_yaml: str = ...,
    ) -> None: ...

class FrameGraph_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[FrameGraph_Request]
    response: list[FrameGraph_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[FrameGraph_Request] = ...,
        response: list[FrameGraph_Response] = ...,
    ) -> None: ...

class FrameGraph:
    Request = FrameGraph_Request
    Response = FrameGraph_Response
    Event = FrameGraph_Event
