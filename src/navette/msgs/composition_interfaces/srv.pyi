# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from array import array

from numpy.typing import ArrayLike, NDArray

from navette.msgs.base import Message
import navette.msgs.rcl_interfaces.msg
import navette.msgs.service_msgs.msg

class ListNodes_Request(Message):
    def __init__(self) -> None: ...

class ListNodes_Response(Message):
    full_node_names: list[str]
    @property
    def unique_ids(self) -> array[int]: ...
    @unique_ids.setter
    def unique_ids(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        full_node_names: list[str] = ...,
        unique_ids: ArrayLike = ...,
    ) -> None: ...

class ListNodes_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ListNodes_Request]
    response: list[ListNodes_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ListNodes_Request] = ...,
        response: list[ListNodes_Response] = ...,
    ) -> None: ...

class ListNodes:
    Request = ListNodes_Request
    Response = ListNodes_Response
    Event = ListNodes_Event

class LoadNode_Request(Message):
    package_name: str
    plugin_name: str
    node_name: str
    node_namespace: str
    log_level: int
    remap_rules: list[str]
    parameters: list[navette.msgs.rcl_interfaces.msg.Parameter]
    extra_arguments: list[navette.msgs.rcl_interfaces.msg.Parameter]
    def __init__(
        self,
        *,
        package_name: str = ...,
        plugin_name: str = ...,
        node_name: str = ...,
        node_namespace: str = ...,
        log_level: int = ...,
        remap_rules: list[str] = ...,
        parameters: list[navette.msgs.rcl_interfaces.msg.Parameter] = ...,
        extra_arguments: list[navette.msgs.rcl_interfaces.msg.Parameter] = ...,
    ) -> None: ...

class LoadNode_Response(Message):
    success: bool
    error_message: str
    full_node_name: str
    unique_id: int
    def __init__(
        self,
        *,
        success: bool = ...,
        error_message: str = ...,
        full_node_name: str = ...,
        unique_id: int = ...,
    ) -> None: ...

class LoadNode_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[LoadNode_Request]
    response: list[LoadNode_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[LoadNode_Request] = ...,
        response: list[LoadNode_Response] = ...,
    ) -> None: ...

class LoadNode:
    Request = LoadNode_Request
    Response = LoadNode_Response
    Event = LoadNode_Event

class UnloadNode_Request(Message):
    unique_id: int
    def __init__(
        self,
        *,
        unique_id: int = ...,
    ) -> None: ...

class UnloadNode_Response(Message):
    success: bool
    error_message: str
    def __init__(
        self,
        *,
        success: bool = ...,
        error_message: str = ...,
    ) -> None: ...

class UnloadNode_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[UnloadNode_Request]
    response: list[UnloadNode_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[UnloadNode_Request] = ...,
        response: list[UnloadNode_Response] = ...,
    ) -> None: ...

class UnloadNode:
    Request = UnloadNode_Request
    Response = UnloadNode_Response
    Event = UnloadNode_Event
