# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from navette.msgs.base import Message
import navette.msgs.sensor_msgs.msg
import navette.msgs.service_msgs.msg

class SetCameraInfo_Request(Message):
    camera_info: navette.msgs.sensor_msgs.msg.CameraInfo
    def __init__(
        self,
        *,
        camera_info: navette.msgs.sensor_msgs.msg.CameraInfo = ...,
    ) -> None: ...

class SetCameraInfo_Response(Message):
    success: bool
    status_message: str
    def __init__(
        self,
        *,
        success: bool = ...,
        status_message: str = ...,
    ) -> None: ...

class SetCameraInfo_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[SetCameraInfo_Request]
    response: list[SetCameraInfo_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[SetCameraInfo_Request] = ...,
        response: list[SetCameraInfo_Response] = ...,
    ) -> None: ...

class SetCameraInfo:
    Request = SetCameraInfo_Request
    Response = SetCameraInfo_Response
    Event = SetCameraInfo_Event
