# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from array import array

from typing import ClassVar

from numpy.typing import ArrayLike, NDArray

from navette.msgs.base import Message
import navette.msgs.builtin_interfaces.msg
import navette.msgs.geometry_msgs.msg
import navette.msgs.std_msgs.msg

class BehaviorTreeLog(Message):
    timestamp: navette.msgs.builtin_interfaces.msg.Time
    event_log: list[BehaviorTreeStatusChange]
    def __init__(
        self,
        *,
        timestamp: navette.msgs.builtin_interfaces.msg.Time = ...,
        event_log: list[BehaviorTreeStatusChange] = ...,
    ) -> None: ...

class BehaviorTreeStatusChange(Message):
    timestamp: navette.msgs.builtin_interfaces.msg.Time
    node_name: str
    uid: int
    previous_status: str
    current_status: str
    def __init__(
        self,
        *,
        timestamp: navette.msgs.builtin_interfaces.msg.Time = ...,
        node_name: str = ...,
        uid: int = ...,
        previous_status: str = ...,
        current_status: str = ...,
    ) -> None: ...

class CollisionDetectorState(Message):
    polygons: list[str]
    detections: list[bool]
    def __init__(
        self,
        *,
        polygons: list[str] = ...,
        detections: list[bool] = ...,
    ) -> None: ...

class CollisionMonitorState(Message):
    DO_NOTHING: ClassVar[int]
    STOP: ClassVar[int]
    SLOWDOWN: ClassVar[int]
    APPROACH: ClassVar[int]
    LIMIT: ClassVar[int]
    action_type: int
    polygon_name: str
    def __init__(
        self,
        *,
        action_type: int = ...,
        polygon_name: str = ...,
    ) -> None: ...

class Costmap(Message):
    header: navette.msgs.std_msgs.msg.Header
    metadata: CostmapMetaData
    @property
    def data(self) -> array[int]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        metadata: CostmapMetaData = ...,
        data: ArrayLike = ...,
    ) -> None: ...

class CostmapFilterInfo(Message):
    header: navette.msgs.std_msgs.msg.Header
    type: int
    filter_mask_topic: str
    base: float
    multiplier: float
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        type: int = ...,
        filter_mask_topic: str = ...,
        base: float = ...,
        multiplier: float = ...,
    ) -> None: ...

class CostmapMetaData(Message):
    map_load_time: navette.msgs.builtin_interfaces.msg.Time
    update_time: navette.msgs.builtin_interfaces.msg.Time
    layer: str
    resolution: float
    size_x: int
    size_y: int
    origin: navette.msgs.geometry_msgs.msg.Pose
    def __init__(
        self,
        *,
        map_load_time: navette.msgs.builtin_interfaces.msg.Time = ...,
        update_time: navette.msgs.builtin_interfaces.msg.Time = ...,
        layer: str = ...,
        resolution: float = ...,
        size_x: int = ...,
        size_y: int = ...,
        origin: navette.msgs.geometry_msgs.msg.Pose = ...,
    ) -> None: ...

class CostmapUpdate(Message):
    header: navette.msgs.std_msgs.msg.Header
    x: int
    y: int
    size_x: int
    size_y: int
    @property
    def data(self) -> array[int]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        x: int = ...,
        y: int = ...,
        size_x: int = ...,
        size_y: int = ...,
        data: ArrayLike = ...,
    ) -> None: ...

class EdgeCost(Message):
    edgeid: int
    cost: float
    def __init__(
        self,
        *,
        edgeid: int = ...,
        cost: float = ...,
    ) -> None: ...

class MissedWaypoint(Message):
    index: int
    goal: navette.msgs.geometry_msgs.msg.PoseStamped
    error_code: int
    def __init__(
        self,
        *,
        index: int = ...,
        goal: navette.msgs.geometry_msgs.msg.PoseStamped = ...,
        error_code: int = ...,
    ) -> None: ...

class Particle(Message):
    pose: navette.msgs.geometry_msgs.msg.Pose
    weight: float
    def __init__(
        self,
        *,
        pose: navette.msgs.geometry_msgs.msg.Pose = ...,
        weight: float = ...,
    ) -> None: ...

class ParticleCloud(Message):
    header: navette.msgs.std_msgs.msg.Header
    particles: list[Particle]
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        particles: list[Particle] = ...,
    ) -> None: ...

class Route(Message):
    header: navette.msgs.std_msgs.msg.Header
    route_cost: float
    nodes: list[RouteNode]
    edges: list[RouteEdge]
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        route_cost: float = ...,
        nodes: list[RouteNode] = ...,
        edges: list[RouteEdge] = ...,
    ) -> None: ...

class RouteEdge(Message):
    edgeid: int
    start: navette.msgs.geometry_msgs.msg.Point
    end: navette.msgs.geometry_msgs.msg.Point
    def __init__(
        self,
        *,
        edgeid: int = ...,
        start: navette.msgs.geometry_msgs.msg.Point = ...,
        end: navette.msgs.geometry_msgs.msg.Point = ...,
    ) -> None: ...

class RouteNode(Message):
    nodeid: int
    position: navette.msgs.geometry_msgs.msg.Point
    def __init__(
        self,
        *,
        nodeid: int = ...,
        position: navette.msgs.geometry_msgs.msg.Point = ...,
    ) -> None: ...

class SpeedLimit(Message):
    header: navette.msgs.std_msgs.msg.Header
    percentage: bool
    speed_limit: float
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        percentage: bool = ...,
        speed_limit: float = ...,
    ) -> None: ...

class VoxelGrid(Message):
    header: navette.msgs.std_msgs.msg.Header
    @property
    def data(self) -> array[int]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    origin: navette.msgs.geometry_msgs.msg.Point32
    resolutions: navette.msgs.geometry_msgs.msg.Vector3
    size_x: int
    size_y: int
    size_z: int
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        data: ArrayLike = ...,
        origin: navette.msgs.geometry_msgs.msg.Point32 = ...,
        resolutions: navette.msgs.geometry_msgs.msg.Vector3 = ...,
        size_x: int = ...,
        size_y: int = ...,
        size_z: int = ...,
    ) -> None: ...
