# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from array import array

from numpy.typing import ArrayLike, NDArray

from navette.msgs.base import Message
import navette.msgs.builtin_interfaces.msg
import navette.msgs.geometry_msgs.msg
import navette.msgs.std_msgs.msg

class JointTrajectory(Message):
    header: navette.msgs.std_msgs.msg.Header
    joint_names: list[str]
    points: list[JointTrajectoryPoint]
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        joint_names: list[str] = ...,
        points: list[JointTrajectoryPoint] = ...,
    ) -> None: ...

class JointTrajectoryPoint(Message):
    @property
    def positions(self) -> array[float]: ...
    @positions.setter
    def positions(self, value: ArrayLike) -> None: ...
    @property
    def velocities(self) -> array[float]: ...
    @velocities.setter
    def velocities(self, value: ArrayLike) -> None: ...
    @property
    def accelerations(self) -> array[float]: ...
    @accelerations.setter
    def accelerations(self, value: ArrayLike) -> None: ...
    @property
    def effort(self) -> array[float]: ...
    @effort.setter
    def effort(self, value: ArrayLike) -> None: ...
    time_from_start: navette.msgs.builtin_interfaces.msg.Duration
    def __init__(
        self,
        *,
        positions: ArrayLike = ...,
        velocities: ArrayLike = ...,
        accelerations: ArrayLike = ...,
        effort: ArrayLike = ...,
        time_from_start: navette.msgs.builtin_interfaces.msg.Duration = ...,
    ) -> None: ...

class MultiDOFJointTrajectory(Message):
    header: navette.msgs.std_msgs.msg.Header
    joint_names: list[str]
    points: list[MultiDOFJointTrajectoryPoint]
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        joint_names: list[str] = ...,
        points: list[MultiDOFJointTrajectoryPoint] = ...,
    ) -> None: ...

class MultiDOFJointTrajectoryPoint(Message):
    transforms: list[navette.msgs.geometry_msgs.msg.Transform]
    velocities: list[navette.msgs.geometry_msgs.msg.Twist]
    accelerations: list[navette.msgs.geometry_msgs.msg.Twist]
    time_from_start: navette.msgs.builtin_interfaces.msg.Duration
    def __init__(
        self,
        *,
        transforms: list[navette.msgs.geometry_msgs.msg.Transform] = ...,
        velocities: list[navette.msgs.geometry_msgs.msg.Twist] = ...,
        accelerations: list[navette.msgs.geometry_msgs.msg.Twist] = ...,
        time_from_start: navette.msgs.builtin_interfaces.msg.Duration = ...,
    ) -> None: ...
