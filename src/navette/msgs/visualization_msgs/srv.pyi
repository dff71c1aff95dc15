# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from navette.msgs.base import Message
import navette.msgs.service_msgs.msg
import navette.msgs.visualization_msgs.msg

class GetInteractiveMarkers_Request(Message):
    def __init__(self) -> None: ...

class GetInteractiveMarkers_Response(Message):
    sequence_number: int
    markers: list[navette.msgs.visualization_msgs.msg.InteractiveMarker]
    def __init__(
        self,
        *,
        sequence_number: int = ...,
        markers: list[navette.msgs.visualization_msgs.msg.InteractiveMarker] = ...,
    ) -> None: ...

class GetInteractiveMarkers_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[GetInteractiveMarkers_Request]
    response: list[GetInteractiveMarkers_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[GetInteractiveMarkers_Request] = ...,
        response: list[GetInteractiveMarkers_Response] = ...,
    ) -> None: ...

class GetInteractiveMarkers:
    Request = GetInteractiveMarkers_Request
    Response = GetInteractiveMarkers_Response
    Event = GetInteractiveMarkers_Event
