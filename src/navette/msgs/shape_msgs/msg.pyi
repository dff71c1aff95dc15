# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from array import array

from typing import ClassVar

import numpy as np

from numpy.typing import ArrayLike, NDArray

from navette.msgs.base import Message
import navette.msgs.geometry_msgs.msg

class Mesh(Message):
    triangles: list[MeshTriangle]
    vertices: list[navette.msgs.geometry_msgs.msg.Point]
    def __init__(
        self,
        *,
        triangles: list[MeshTriangle] = ...,
        vertices: list[navette.msgs.geometry_msgs.msg.Point] = ...,
    ) -> None: ...

class MeshTriangle(Message):
    @property
    def vertex_indices(self) -> NDArray[np.uint32]: ...
    @vertex_indices.setter
    def vertex_indices(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        vertex_indices: ArrayLike = ...,
    ) -> None: ...

class Plane(Message):
    @property
    def coef(self) -> NDArray[np.float64]: ...
    @coef.setter
    def coef(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        coef: ArrayLike = ...,
    ) -> None: ...

class SolidPrimitive(Message):
    BOX: ClassVar[int]
    SPHERE: ClassVar[int]
    CYLINDER: ClassVar[int]
    CONE: ClassVar[int]
    PRISM: ClassVar[int]
    BOX_X: ClassVar[int]
    BOX_Y: ClassVar[int]
    BOX_Z: ClassVar[int]
    SPHERE_RADIUS: ClassVar[int]
    CYLINDER_HEIGHT: ClassVar[int]
    CYLINDER_RADIUS: ClassVar[int]
    CONE_HEIGHT: ClassVar[int]
    CONE_RADIUS: ClassVar[int]
    PRISM_HEIGHT: ClassVar[int]
    type: int
    @property
    def dimensions(self) -> array[float]: ...
    @dimensions.setter
    def dimensions(self, value: ArrayLike) -> None: ...
    polygon: navette.msgs.geometry_msgs.msg.Polygon
    def __init__(
        self,
        *,
        type: int = ...,
        dimensions: ArrayLike = ...,
        polygon: navette.msgs.geometry_msgs.msg.Polygon = ...,
    ) -> None: ...
