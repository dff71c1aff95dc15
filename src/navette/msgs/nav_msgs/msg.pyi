# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from array import array

from numpy.typing import ArrayLike, NDArray

from navette.msgs.base import Message
import navette.msgs.builtin_interfaces.msg
import navette.msgs.geometry_msgs.msg
import navette.msgs.std_msgs.msg

class GridCells(Message):
    header: navette.msgs.std_msgs.msg.Header
    cell_width: float
    cell_height: float
    cells: list[navette.msgs.geometry_msgs.msg.Point]
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        cell_width: float = ...,
        cell_height: float = ...,
        cells: list[navette.msgs.geometry_msgs.msg.Point] = ...,
    ) -> None: ...

class MapMetaData(Message):
    map_load_time: navette.msgs.builtin_interfaces.msg.Time
    resolution: float
    width: int
    height: int
    origin: navette.msgs.geometry_msgs.msg.Pose
    def __init__(
        self,
        *,
        map_load_time: navette.msgs.builtin_interfaces.msg.Time = ...,
        resolution: float = ...,
        width: int = ...,
        height: int = ...,
        origin: navette.msgs.geometry_msgs.msg.Pose = ...,
    ) -> None: ...

class OccupancyGrid(Message):
    header: navette.msgs.std_msgs.msg.Header
    info: MapMetaData
    @property
    def data(self) -> array[int]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        info: MapMetaData = ...,
        data: ArrayLike = ...,
    ) -> None: ...

class Odometry(Message):
    header: navette.msgs.std_msgs.msg.Header
    child_frame_id: str
    pose: navette.msgs.geometry_msgs.msg.PoseWithCovariance
    twist: navette.msgs.geometry_msgs.msg.TwistWithCovariance
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        child_frame_id: str = ...,
        pose: navette.msgs.geometry_msgs.msg.PoseWithCovariance = ...,
        twist: navette.msgs.geometry_msgs.msg.TwistWithCovariance = ...,
    ) -> None: ...

class Path(Message):
    header: navette.msgs.std_msgs.msg.Header
    poses: list[navette.msgs.geometry_msgs.msg.PoseStamped]
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        poses: list[navette.msgs.geometry_msgs.msg.PoseStamped] = ...,
    ) -> None: ...
