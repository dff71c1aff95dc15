# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from array import array

from typing import ClassVar

from numpy.typing import ArrayLike, NDArray

from navette.msgs.base import Message
import navette.msgs.builtin_interfaces.msg
import navette.msgs.geometry_msgs.msg
import navette.msgs.sensor_msgs.msg
import navette.msgs.std_msgs.msg

class ImageMarker(Message):
    CIRCLE: ClassVar[int]
    LINE_STRIP: ClassVar[int]
    LINE_LIST: ClassVar[int]
    POLYGON: ClassVar[int]
    POINTS: ClassVar[int]
    ADD: ClassVar[int]
    REMOVE: ClassVar[int]
    header: navette.msgs.std_msgs.msg.Header
    ns: str
    id: int
    type: int
    action: int
    position: navette.msgs.geometry_msgs.msg.Point
    scale: float
    outline_color: navette.msgs.std_msgs.msg.ColorRGBA
    filled: int
    fill_color: navette.msgs.std_msgs.msg.ColorRGBA
    lifetime: navette.msgs.builtin_interfaces.msg.Duration
    points: list[navette.msgs.geometry_msgs.msg.Point]
    outline_colors: list[navette.msgs.std_msgs.msg.ColorRGBA]
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        ns: str = ...,
        id: int = ...,
        type: int = ...,
        action: int = ...,
        position: navette.msgs.geometry_msgs.msg.Point = ...,
        scale: float = ...,
        outline_color: navette.msgs.std_msgs.msg.ColorRGBA = ...,
        filled: int = ...,
        fill_color: navette.msgs.std_msgs.msg.ColorRGBA = ...,
        lifetime: navette.msgs.builtin_interfaces.msg.Duration = ...,
        points: list[navette.msgs.geometry_msgs.msg.Point] = ...,
        outline_colors: list[navette.msgs.std_msgs.msg.ColorRGBA] = ...,
    ) -> None: ...

class InteractiveMarker(Message):
    header: navette.msgs.std_msgs.msg.Header
    pose: navette.msgs.geometry_msgs.msg.Pose
    name: str
    description: str
    scale: float
    menu_entries: list[MenuEntry]
    controls: list[InteractiveMarkerControl]
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        pose: navette.msgs.geometry_msgs.msg.Pose = ...,
        name: str = ...,
        description: str = ...,
        scale: float = ...,
        menu_entries: list[MenuEntry] = ...,
        controls: list[InteractiveMarkerControl] = ...,
    ) -> None: ...

class InteractiveMarkerControl(Message):
    INHERIT: ClassVar[int]
    FIXED: ClassVar[int]
    VIEW_FACING: ClassVar[int]
    NONE: ClassVar[int]
    MENU: ClassVar[int]
    BUTTON: ClassVar[int]
    MOVE_AXIS: ClassVar[int]
    MOVE_PLANE: ClassVar[int]
    ROTATE_AXIS: ClassVar[int]
    MOVE_ROTATE: ClassVar[int]
    MOVE_3D: ClassVar[int]
    ROTATE_3D: ClassVar[int]
    MOVE_ROTATE_3D: ClassVar[int]
    name: str
    orientation: navette.msgs.geometry_msgs.msg.Quaternion
    orientation_mode: int
    interaction_mode: int
    always_visible: bool
    markers: list[Marker]
    independent_marker_orientation: bool
    description: str
    def __init__(
        self,
        *,
        name: str = ...,
        orientation: navette.msgs.geometry_msgs.msg.Quaternion = ...,
        orientation_mode: int = ...,
        interaction_mode: int = ...,
        always_visible: bool = ...,
        markers: list[Marker] = ...,
        independent_marker_orientation: bool = ...,
        description: str = ...,
    ) -> None: ...

class InteractiveMarkerFeedback(Message):
    KEEP_ALIVE: ClassVar[int]
    POSE_UPDATE: ClassVar[int]
    MENU_SELECT: ClassVar[int]
    BUTTON_CLICK: ClassVar[int]
    MOUSE_DOWN: ClassVar[int]
    MOUSE_UP: ClassVar[int]
    header: navette.msgs.std_msgs.msg.Header
    client_id: str
    marker_name: str
    control_name: str
    event_type: int
    pose: navette.msgs.geometry_msgs.msg.Pose
    menu_entry_id: int
    mouse_point: navette.msgs.geometry_msgs.msg.Point
    mouse_point_valid: bool
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        client_id: str = ...,
        marker_name: str = ...,
        control_name: str = ...,
        event_type: int = ...,
        pose: navette.msgs.geometry_msgs.msg.Pose = ...,
        menu_entry_id: int = ...,
        mouse_point: navette.msgs.geometry_msgs.msg.Point = ...,
        mouse_point_valid: bool = ...,
    ) -> None: ...

class InteractiveMarkerInit(Message):
    server_id: str
    seq_num: int
    markers: list[InteractiveMarker]
    def __init__(
        self,
        *,
        server_id: str = ...,
        seq_num: int = ...,
        markers: list[InteractiveMarker] = ...,
    ) -> None: ...

class InteractiveMarkerPose(Message):
    header: navette.msgs.std_msgs.msg.Header
    pose: navette.msgs.geometry_msgs.msg.Pose
    name: str
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        pose: navette.msgs.geometry_msgs.msg.Pose = ...,
        name: str = ...,
    ) -> None: ...

class InteractiveMarkerUpdate(Message):
    KEEP_ALIVE: ClassVar[int]
    UPDATE: ClassVar[int]
    server_id: str
    seq_num: int
    type: int
    markers: list[InteractiveMarker]
    poses: list[InteractiveMarkerPose]
    erases: list[str]
    def __init__(
        self,
        *,
        server_id: str = ...,
        seq_num: int = ...,
        type: int = ...,
        markers: list[InteractiveMarker] = ...,
        poses: list[InteractiveMarkerPose] = ...,
        erases: list[str] = ...,
    ) -> None: ...

class Marker(Message):
    ARROW: ClassVar[int]
    CUBE: ClassVar[int]
    SPHERE: ClassVar[int]
    CYLINDER: ClassVar[int]
    LINE_STRIP: ClassVar[int]
    LINE_LIST: ClassVar[int]
    CUBE_LIST: ClassVar[int]
    SPHERE_LIST: ClassVar[int]
    POINTS: ClassVar[int]
    TEXT_VIEW_FACING: ClassVar[int]
    MESH_RESOURCE: ClassVar[int]
    TRIANGLE_LIST: ClassVar[int]
    ARROW_STRIP: ClassVar[int]
    ADD: ClassVar[int]
    MODIFY: ClassVar[int]
    DELETE: ClassVar[int]
    DELETEALL: ClassVar[int]
    header: navette.msgs.std_msgs.msg.Header
    ns: str
    id: int
    type: int
    action: int
    pose: navette.msgs.geometry_msgs.msg.Pose
    scale: navette.msgs.geometry_msgs.msg.Vector3
    color: navette.msgs.std_msgs.msg.ColorRGBA
    lifetime: navette.msgs.builtin_interfaces.msg.Duration
    frame_locked: bool
    points: list[navette.msgs.geometry_msgs.msg.Point]
    colors: list[navette.msgs.std_msgs.msg.ColorRGBA]
    texture_resource: str
    texture: navette.msgs.sensor_msgs.msg.CompressedImage
    uv_coordinates: list[UVCoordinate]
    text: str
    mesh_resource: str
    mesh_file: MeshFile
    mesh_use_embedded_materials: bool
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        ns: str = ...,
        id: int = ...,
        type: int = ...,
        action: int = ...,
        pose: navette.msgs.geometry_msgs.msg.Pose = ...,
        scale: navette.msgs.geometry_msgs.msg.Vector3 = ...,
        color: navette.msgs.std_msgs.msg.ColorRGBA = ...,
        lifetime: navette.msgs.builtin_interfaces.msg.Duration = ...,
        frame_locked: bool = ...,
        points: list[navette.msgs.geometry_msgs.msg.Point] = ...,
        colors: list[navette.msgs.std_msgs.msg.ColorRGBA] = ...,
        texture_resource: str = ...,
        texture: navette.msgs.sensor_msgs.msg.CompressedImage = ...,
        uv_coordinates: list[UVCoordinate] = ...,
        text: str = ...,
        mesh_resource: str = ...,
        mesh_file: MeshFile = ...,
        mesh_use_embedded_materials: bool = ...,
    ) -> None: ...

class MarkerArray(Message):
    markers: list[Marker]
    def __init__(
        self,
        *,
        markers: list[Marker] = ...,
    ) -> None: ...

class MenuEntry(Message):
    FEEDBACK: ClassVar[int]
    ROSRUN: ClassVar[int]
    ROSLAUNCH: ClassVar[int]
    id: int
    parent_id: int
    title: str
    command: str
    command_type: int
    def __init__(
        self,
        *,
        id: int = ...,
        parent_id: int = ...,
        title: str = ...,
        command: str = ...,
        command_type: int = ...,
    ) -> None: ...

class MeshFile(Message):
    filename: str
    @property
    def data(self) -> array[int]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        filename: str = ...,
        data: ArrayLike = ...,
    ) -> None: ...

class UVCoordinate(Message):
    u: float
    v: float
    def __init__(
        self,
        *,
        u: float = ...,
        v: float = ...,
    ) -> None: ...
