# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from array import array

from typing import ClassVar

from numpy.typing import ArrayLike, NDArray

from navette.msgs.base import Message
import navette.msgs.rcl_interfaces.msg
import navette.msgs.service_msgs.msg

class DescribeParameters_Request(Message):
    names: list[str]
    def __init__(
        self,
        *,
        names: list[str] = ...,
    ) -> None: ...

class DescribeParameters_Response(Message):
    descriptors: list[navette.msgs.rcl_interfaces.msg.ParameterDescriptor]
    def __init__(
        self,
        *,
        descriptors: list[navette.msgs.rcl_interfaces.msg.ParameterDescriptor] = ...,
    ) -> None: ...

class DescribeParameters_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[DescribeParameters_Request]
    response: list[DescribeParameters_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[DescribeParameters_Request] = ...,
        response: list[DescribeParameters_Response] = ...,
    ) -> None: ...

class DescribeParameters:
    Request = DescribeParameters_Request
    Response = DescribeParameters_Response
    Event = DescribeParameters_Event

class GetLoggerLevels_Request(Message):
    names: list[str]
    def __init__(
        self,
        *,
        names: list[str] = ...,
    ) -> None: ...

class GetLoggerLevels_Response(Message):
    levels: list[navette.msgs.rcl_interfaces.msg.LoggerLevel]
    def __init__(
        self,
        *,
        levels: list[navette.msgs.rcl_interfaces.msg.LoggerLevel] = ...,
    ) -> None: ...

class GetLoggerLevels_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[GetLoggerLevels_Request]
    response: list[GetLoggerLevels_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[GetLoggerLevels_Request] = ...,
        response: list[GetLoggerLevels_Response] = ...,
    ) -> None: ...

class GetLoggerLevels:
    Request = GetLoggerLevels_Request
    Response = GetLoggerLevels_Response
    Event = GetLoggerLevels_Event

class GetParameterTypes_Request(Message):
    names: list[str]
    def __init__(
        self,
        *,
        names: list[str] = ...,
    ) -> None: ...

class GetParameterTypes_Response(Message):
    @property
    def types(self) -> array[int]: ...
    @types.setter
    def types(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        types: ArrayLike = ...,
    ) -> None: ...

class GetParameterTypes_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[GetParameterTypes_Request]
    response: list[GetParameterTypes_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[GetParameterTypes_Request] = ...,
        response: list[GetParameterTypes_Response] = ...,
    ) -> None: ...

class GetParameterTypes:
    Request = GetParameterTypes_Request
    Response = GetParameterTypes_Response
    Event = GetParameterTypes_Event

class GetParameters_Request(Message):
    names: list[str]
    def __init__(
        self,
        *,
        names: list[str] = ...,
    ) -> None: ...

class GetParameters_Response(Message):
    values: list[navette.msgs.rcl_interfaces.msg.ParameterValue]
    def __init__(
        self,
        *,
        values: list[navette.msgs.rcl_interfaces.msg.ParameterValue] = ...,
    ) -> None: ...

class GetParameters_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[GetParameters_Request]
    response: list[GetParameters_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[GetParameters_Request] = ...,
        response: list[GetParameters_Response] = ...,
    ) -> None: ...

class GetParameters:
    Request = GetParameters_Request
    Response = GetParameters_Response
    Event = GetParameters_Event

class ListParameters_Request(Message):
    DEPTH_RECURSIVE: ClassVar[int]
    prefixes: list[str]
    depth: int
    def __init__(
        self,
        *,
        prefixes: list[str] = ...,
        depth: int = ...,
    ) -> None: ...

class ListParameters_Response(Message):
    result: navette.msgs.rcl_interfaces.msg.ListParametersResult
    def __init__(
        self,
        *,
        result: navette.msgs.rcl_interfaces.msg.ListParametersResult = ...,
    ) -> None: ...

class ListParameters_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ListParameters_Request]
    response: list[ListParameters_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ListParameters_Request] = ...,
        response: list[ListParameters_Response] = ...,
    ) -> None: ...

class ListParameters:
    Request = ListParameters_Request
    Response = ListParameters_Response
    Event = ListParameters_Event

class SetLoggerLevels_Request(Message):
    levels: list[navette.msgs.rcl_interfaces.msg.LoggerLevel]
    def __init__(
        self,
        *,
        levels: list[navette.msgs.rcl_interfaces.msg.LoggerLevel] = ...,
    ) -> None: ...

class SetLoggerLevels_Response(Message):
    results: list[navette.msgs.rcl_interfaces.msg.SetLoggerLevelsResult]
    def __init__(
        self,
        *,
        results: list[navette.msgs.rcl_interfaces.msg.SetLoggerLevelsResult] = ...,
    ) -> None: ...

class SetLoggerLevels_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[SetLoggerLevels_Request]
    response: list[SetLoggerLevels_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[SetLoggerLevels_Request] = ...,
        response: list[SetLoggerLevels_Response] = ...,
    ) -> None: ...

class SetLoggerLevels:
    Request = SetLoggerLevels_Request
    Response = SetLoggerLevels_Response
    Event = SetLoggerLevels_Event

class SetParameters_Request(Message):
    parameters: list[navette.msgs.rcl_interfaces.msg.Parameter]
    def __init__(
        self,
        *,
        parameters: list[navette.msgs.rcl_interfaces.msg.Parameter] = ...,
    ) -> None: ...

class SetParameters_Response(Message):
    results: list[navette.msgs.rcl_interfaces.msg.SetParametersResult]
    def __init__(
        self,
        *,
        results: list[navette.msgs.rcl_interfaces.msg.SetParametersResult] = ...,
    ) -> None: ...

class SetParameters_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[SetParameters_Request]
    response: list[SetParameters_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[SetParameters_Request] = ...,
        response: list[SetParameters_Response] = ...,
    ) -> None: ...

class SetParameters:
    Request = SetParameters_Request
    Response = SetParameters_Response
    Event = SetParameters_Event

class SetParametersAtomically_Request(Message):
    parameters: list[navette.msgs.rcl_interfaces.msg.Parameter]
    def __init__(
        self,
        *,
        parameters: list[navette.msgs.rcl_interfaces.msg.Parameter] = ...,
    ) -> None: ...

class SetParametersAtomically_Response(Message):
    result: navette.msgs.rcl_interfaces.msg.SetParametersResult
    def __init__(
        self,
        *,
        result: navette.msgs.rcl_interfaces.msg.SetParametersResult = ...,
    ) -> None: ...

class SetParametersAtomically_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[SetParametersAtomically_Request]
    response: list[SetParametersAtomically_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[SetParametersAtomically_Request] = ...,
        response: list[SetParametersAtomically_Response] = ...,
    ) -> None: ...

class SetParametersAtomically:
    Request = SetParametersAtomically_Request
    Response = SetParametersAtomically_Response
    Event = SetParametersAtomically_Event
