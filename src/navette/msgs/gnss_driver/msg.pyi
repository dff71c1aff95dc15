# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from navette.msgs.base import Message
import navette.msgs.std_msgs.msg

class Gps(Message):
    header: navette.msgs.std_msgs.msg.Header
    localization: Pose
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        localization: Pose = ...,
    ) -> None: ...

class Point3D(Message):
    x: float
    y: float
    z: float
    def __init__(
        self,
        *,
        x: float = ...,
        y: float = ...,
        z: float = ...,
    ) -> None: ...

class PointENU(Message):
    x: float
    y: float
    z: float
    def __init__(
        self,
        *,
        x: float = ...,
        y: float = ...,
        z: float = ...,
    ) -> None: ...

class Pose(Message):
    position: PointENU
    orientation: Quaternion
    linear_velocity: Point3D
    linear_acceleration: Point3D
    angular_velocity: Point3D
    heading: float
    linear_acceleration_vrf: Point3D
    angular_velocity_vrf: Point3D
    def __init__(
        self,
        *,
        position: PointENU = ...,
        orientation: Quaternion = ...,
        linear_velocity: Point3D = ...,
        linear_acceleration: Point3D = ...,
        angular_velocity: Point3D = ...,
        heading: float = ...,
        linear_acceleration_vrf: Point3D = ...,
        angular_velocity_vrf: Point3D = ...,
    ) -> None: ...

class Quaternion(Message):
    qx: float
    qy: float
    qz: float
    qw: float
    def __init__(
        self,
        *,
        qx: float = ...,
        qy: float = ...,
        qz: float = ...,
        qw: float = ...,
    ) -> None: ...
