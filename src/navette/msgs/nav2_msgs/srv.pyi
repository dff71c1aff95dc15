# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from array import array

from typing import ClassVar

from numpy.typing import ArrayLike, NDArray

from navette.msgs.base import Message
import navette.msgs.geometry_msgs.msg
import navette.msgs.nav2_msgs.msg
import navette.msgs.nav_msgs.msg
import navette.msgs.service_msgs.msg
import navette.msgs.std_msgs.msg

class ClearCostmapAroundPose_Request(Message):
    pose: navette.msgs.geometry_msgs.msg.PoseStamped
    reset_distance: float
    def __init__(
        self,
        *,
        pose: navette.msgs.geometry_msgs.msg.PoseStamped = ...,
        reset_distance: float = ...,
    ) -> None: ...

class ClearCostmapAroundPose_Response(Message):
    response: navette.msgs.std_msgs.msg.Empty
    def __init__(
        self,
        *,
        response: navette.msgs.std_msgs.msg.Empty = ...,
    ) -> None: ...

class ClearCostmapAroundPose_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ClearCostmapAroundPose_Request]
    response: list[ClearCostmapAroundPose_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ClearCostmapAroundPose_Request] = ...,
        response: list[ClearCostmapAroundPose_Response] = ...,
    ) -> None: ...

class ClearCostmapAroundPose:
    Request = ClearCostmapAroundPose_Request
    Response = ClearCostmapAroundPose_Response
    Event = ClearCostmapAroundPose_Event

class ClearCostmapAroundRobot_Request(Message):
    reset_distance: float
    def __init__(
        self,
        *,
        reset_distance: float = ...,
    ) -> None: ...

class ClearCostmapAroundRobot_Response(Message):
    response: navette.msgs.std_msgs.msg.Empty
    def __init__(
        self,
        *,
        response: navette.msgs.std_msgs.msg.Empty = ...,
    ) -> None: ...

class ClearCostmapAroundRobot_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ClearCostmapAroundRobot_Request]
    response: list[ClearCostmapAroundRobot_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ClearCostmapAroundRobot_Request] = ...,
        response: list[ClearCostmapAroundRobot_Response] = ...,
    ) -> None: ...

class ClearCostmapAroundRobot:
    Request = ClearCostmapAroundRobot_Request
    Response = ClearCostmapAroundRobot_Response
    Event = ClearCostmapAroundRobot_Event

class ClearCostmapExceptRegion_Request(Message):
    reset_distance: float
    def __init__(
        self,
        *,
        reset_distance: float = ...,
    ) -> None: ...

class ClearCostmapExceptRegion_Response(Message):
    response: navette.msgs.std_msgs.msg.Empty
    def __init__(
        self,
        *,
        response: navette.msgs.std_msgs.msg.Empty = ...,
    ) -> None: ...

class ClearCostmapExceptRegion_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ClearCostmapExceptRegion_Request]
    response: list[ClearCostmapExceptRegion_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ClearCostmapExceptRegion_Request] = ...,
        response: list[ClearCostmapExceptRegion_Response] = ...,
    ) -> None: ...

class ClearCostmapExceptRegion:
    Request = ClearCostmapExceptRegion_Request
    Response = ClearCostmapExceptRegion_Response
    Event = ClearCostmapExceptRegion_Event

class ClearEntireCostmap_Request(Message):
    request: navette.msgs.std_msgs.msg.Empty
    def __init__(
        self,
        *,
        request: navette.msgs.std_msgs.msg.Empty = ...,
    ) -> None: ...

class ClearEntireCostmap_Response(Message):
    response: navette.msgs.std_msgs.msg.Empty
    def __init__(
        self,
        *,
        response: navette.msgs.std_msgs.msg.Empty = ...,
    ) -> None: ...

class ClearEntireCostmap_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ClearEntireCostmap_Request]
    response: list[ClearEntireCostmap_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ClearEntireCostmap_Request] = ...,
        response: list[ClearEntireCostmap_Response] = ...,
    ) -> None: ...

class ClearEntireCostmap:
    Request = ClearEntireCostmap_Request
    Response = ClearEntireCostmap_Response
    Event = ClearEntireCostmap_Event

class DynamicEdges_Request(Message):
    @property
    def closed_edges(self) -> array[int]: ...
    @closed_edges.setter
    def closed_edges(self, value: ArrayLike) -> None: ...
    @property
    def opened_edges(self) -> array[int]: ...
    @opened_edges.setter
    def opened_edges(self, value: ArrayLike) -> None: ...
    adjust_edges: list[navette.msgs.nav2_msgs.msg.EdgeCost]
    def __init__(
        self,
        *,
        closed_edges: ArrayLike = ...,
        opened_edges: ArrayLike = ...,
        adjust_edges: list[navette.msgs.nav2_msgs.msg.EdgeCost] = ...,
    ) -> None: ...

class DynamicEdges_Response(Message):
    success: bool
    def __init__(
        self,
        *,
        success: bool = ...,
    ) -> None: ...

class DynamicEdges_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[DynamicEdges_Request]
    response: list[DynamicEdges_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[DynamicEdges_Request] = ...,
        response: list[DynamicEdges_Response] = ...,
    ) -> None: ...

class DynamicEdges:
    Request = DynamicEdges_Request
    Response = DynamicEdges_Response
    Event = DynamicEdges_Event

class GetCost_Request(Message):
    use_footprint: bool
    x: float
    y: float
    theta: float
    def __init__(
        self,
        *,
        use_footprint: bool = ...,
        x: float = ...,
        y: float = ...,
        theta: float = ...,
    ) -> None: ...

class GetCost_Response(Message):
    cost: float
    def __init__(
        self,
        *,
        cost: float = ...,
    ) -> None: ...

class GetCost_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[GetCost_Request]
    response: list[GetCost_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[GetCost_Request] = ...,
        response: list[GetCost_Response] = ...,
    ) -> None: ...

class GetCost:
    Request = GetCost_Request
    Response = GetCost_Response
    Event = GetCost_Event

class GetCostmap_Request(Message):
    specs: navette.msgs.nav2_msgs.msg.CostmapMetaData
    def __init__(
        self,
        *,
        specs: navette.msgs.nav2_msgs.msg.CostmapMetaData = ...,
    ) -> None: ...

class GetCostmap_Response(Message):
    map: navette.msgs.nav2_msgs.msg.Costmap
    def __init__(
        self,
        *,
        map: navette.msgs.nav2_msgs.msg.Costmap = ...,
    ) -> None: ...

class GetCostmap_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[GetCostmap_Request]
    response: list[GetCostmap_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[GetCostmap_Request] = ...,
        response: list[GetCostmap_Response] = ...,
    ) -> None: ...

class GetCostmap:
    Request = GetCostmap_Request
    Response = GetCostmap_Response
    Event = GetCostmap_Event

class IsPathValid_Request(Message):
    path: navette.msgs.nav_msgs.msg.Path
    def __init__(
        self,
        *,
        path: navette.msgs.nav_msgs.msg.Path = ...,
    ) -> None: ...

class IsPathValid_Response(Message):
    is_valid: bool
    @property
    def invalid_pose_indices(self) -> array[int]: ...
    @invalid_pose_indices.setter
    def invalid_pose_indices(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        is_valid: bool = ...,
        invalid_pose_indices: ArrayLike = ...,
    ) -> None: ...

class IsPathValid_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[IsPathValid_Request]
    response: list[IsPathValid_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[IsPathValid_Request] = ...,
        response: list[IsPathValid_Response] = ...,
    ) -> None: ...

class IsPathValid:
    Request = IsPathValid_Request
    Response = IsPathValid_Response
    Event = IsPathValid_Event

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

class ManageLifecycleNodes_Request(Message):
    STARTUP: ClassVar[int]
    PAUSE: ClassVar[int]
    RESUME: ClassVar[int]
    RESET: ClassVar[int]
    SHUTDOWN: ClassVar[int]
    CONFIGURE: ClassVar[int]
    CLEANUP: ClassVar[int]
    command: int
    def __init__(
        self,
        *,
        command: int = ...,
    ) -> None: ...

class ManageLifecycleNodes_Response(Message):
    success: bool
    def __init__(
        self,
        *,
        success: bool = ...,
    ) -> None: ...

class ManageLifecycleNodes_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ManageLifecycleNodes_Request]
    response: list[ManageLifecycleNodes_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ManageLifecycleNodes_Request] = ...,
        response: list[ManageLifecycleNodes_Response] = ...,
    ) -> None: ...

class ManageLifecycleNodes:
    Request = ManageLifecycleNodes_Request
    Response = ManageLifecycleNodes_Response
    Event = ManageLifecycleNodes_Event

class ReloadDockDatabase_Request(Message):
    filepath: str
    def __init__(
        self,
        *,
        filepath: str = ...,
    ) -> None: ...

class ReloadDockDatabase_Response(Message):
    success: bool
    def __init__(
        self,
        *,
        success: bool = ...,
    ) -> None: ...

class ReloadDockDatabase_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ReloadDockDatabase_Request]
    response: list[ReloadDockDatabase_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ReloadDockDatabase_Request] = ...,
        response: list[ReloadDockDatabase_Response] = ...,
    ) -> None: ...

class ReloadDockDatabase:
    Request = ReloadDockDatabase_Request
    Response = ReloadDockDatabase_Response
    Event = ReloadDockDatabase_Event

class SaveMap_Request(Message):
    map_topic: str
    map_url: str
    image_format: str
    map_mode: str
    free_thresh: float
    occupied_thresh: float
    def __init__(
        self,
        *,
        map_topic: str = ...,
        map_url: str = ...,
        image_format: str = ...,
        map_mode: str = ...,
        free_thresh: float = ...,
        occupied_thresh: float = ...,
    ) -> None: ...

class SaveMap_Response(Message):
    result: bool
    def __init__(
        self,
        *,
        result: bool = ...,
    ) -> None: ...

class SaveMap_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[SaveMap_Request]
    response: list[SaveMap_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[SaveMap_Request] = ...,
        response: list[SaveMap_Response] = ...,
    ) -> None: ...

class SaveMap:
    Request = SaveMap_Request
    Response = SaveMap_Response
    Event = SaveMap_Event

class SetInitialPose_Request(Message):
    pose: navette.msgs.geometry_msgs.msg.PoseWithCovarianceStamped
    def __init__(
        self,
        *,
        pose: navette.msgs.geometry_msgs.msg.PoseWithCovarianceStamped = ...,
    ) -> None: ...

class SetInitialPose_Response(Message):
    def __init__(self) -> None: ...

class SetInitialPose_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[SetInitialPose_Request]
    response: list[SetInitialPose_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[SetInitialPose_Request] = ...,
        response: list[SetInitialPose_Response] = ...,
    ) -> None: ...

class SetInitialPose:
    Request = SetInitialPose_Request
    Response = SetInitialPose_Response
    Event = SetInitialPose_Event

class SetRouteGraph_Request(Message):
    graph_filepath: str
    def __init__(
        self,
        *,
        graph_filepath: str = ...,
    ) -> None: ...

class SetRouteGraph_Response(Message):
    success: bool
    def __init__(
        self,
        *,
        success: bool = ...,
    ) -> None: ...

class SetRouteGraph_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[SetRouteGraph_Request]
    response: list[SetRouteGraph_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[SetRouteGraph_Request] = ...,
        response: list[SetRouteGraph_Response] = ...,
    ) -> None: ...

class SetRouteGraph:
    Request = SetRouteGraph_Request
    Response = SetRouteGraph_Response
    Event = SetRouteGraph_Event

class Toggle_Request(Message):
    enable: bool
    def __init__(
        self,
        *,
        enable: bool = ...,
    ) -> None: ...

class Toggle_Response(Message):
    success: bool
    message: str
    def __init__(
        self,
        *,
        success: bool = ...,
        message: str = ...,
    ) -> None: ...

class Toggle_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[Toggle_Request]
    response: list[Toggle_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[Toggle_Request] = ...,
        response: list[Toggle_Response] = ...,
    ) -> None: ...

class Toggle:
    Request = Toggle_Request
    Response = Toggle_Response
    Event = Toggle_Event
