# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from typing import ClassVar

from navette.msgs.base import Message
import navette.msgs.geometry_msgs.msg
import navette.msgs.nav_msgs.msg
import navette.msgs.service_msgs.msg

class GetMap_Request(Message):
    def __init__(self) -> None: ...

class GetMap_Response(Message):
    map: navette.msgs.nav_msgs.msg.OccupancyGrid
    def __init__(
        self,
        *,
        map: navette.msgs.nav_msgs.msg.OccupancyGrid = ...,
    ) -> None: ...

class GetMap_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[GetMap_Request]
    response: list[GetMap_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[GetMap_Request] = ...,
        response: list[GetMap_Response] = ...,
    ) -> None: ...

class GetMap:
    Request = GetMap_Request
    Response = GetMap_Response
    Event = GetMap_Event

class GetPlan_Request(Message):
    start: navette.msgs.geometry_msgs.msg.PoseStamped
    goal: navette.msgs.geometry_msgs.msg.PoseStamped
    tolerance: float
    def __init__(
        self,
        *,
        start: navette.msgs.geometry_msgs.msg.PoseStamped = ...,
        goal: navette.msgs.geometry_msgs.msg.PoseStamped = ...,
        tolerance: float = ...,
    ) -> None: ...

class GetPlan_Response(Message):
    plan: navette.msgs.nav_msgs.msg.Path
    def __init__(
        self,
        *,
        plan: navette.msgs.nav_msgs.msg.Path = ...,
    ) -> None: ...

class GetPlan_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[GetPlan_Request]
    response: list[GetPlan_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[GetPlan_Request] = ...,
        response: list[GetPlan_Response] = ...,
    ) -> None: ...

class GetPlan:
    Request = GetPlan_Request
    Response = GetPlan_Response
    Event = GetPlan_Event

class LoadMap_Request(Message):
    map_url: str
    def __init__(
        self,
        *,
        map_url: str = ...,
    ) -> None: ...

class LoadMap_Response(Message):
    RESULT_SUCCESS: ClassVar[int]
    RESULT_MAP_DOES_NOT_EXIST: ClassVar[int]
    RESULT_INVALID_MAP_DATA: ClassVar[int]
    RESULT_INVALID_MAP_METADATA: ClassVar[int]
    RESULT_UNDEFINED_FAILURE: ClassVar[int]
    map: navette.msgs.nav_msgs.msg.OccupancyGrid
    result: int
    def __init__(
        self,
        *,
        map: navette.msgs.nav_msgs.msg.OccupancyGrid = ...,
        result: int = ...,
    ) -> None: ...

class LoadMap_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[LoadMap_Request]
    response: list[LoadMap_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[LoadMap_Request] = ...,
        response: list[LoadMap_Response] = ...,
    ) -> None: ...

class LoadMap:
    Request = LoadMap_Request
    Response = LoadMap_Response
    Event = LoadMap_Event

class SetMap_Request(Message):
    map: navette.msgs.nav_msgs.msg.OccupancyGrid
    initial_pose: navette.msgs.geometry_msgs.msg.PoseWithCovarianceStamped
    def __init__(
        self,
        *,
        map: navette.msgs.nav_msgs.msg.OccupancyGrid = ...,
        initial_pose: navette.msgs.geometry_msgs.msg.PoseWithCovarianceStamped = ...,
    ) -> None: ...

class SetMap_Response(Message):
    success: bool
    def __init__(
        self,
        *,
        success: bool = ...,
    ) -> None: ...

class SetMap_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[SetMap_Request]
    response: list[SetMap_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[SetMap_Request] = ...,
        response: list[SetMap_Response] = ...,
    ) -> None: ...

class SetMap:
    Request = SetMap_Request
    Response = SetMap_Response
    Event = SetMap_Event
