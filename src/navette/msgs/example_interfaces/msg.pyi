# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from array import array

from numpy.typing import ArrayLike, NDArray

from navette.msgs.base import Message

class Bool(Message):
    data: bool
    def __init__(
        self,
        *,
        data: bool = ...,
    ) -> None: ...

class Byte(Message):
    data: bytes
    def __init__(
        self,
        *,
        data: bytes = ...,
    ) -> None: ...

class ByteMultiArray(Message):
    layout: MultiArrayLayout
    data: list[bytes]
    def __init__(
        self,
        *,
        layout: MultiArrayLayout = ...,
        data: list[bytes] = ...,
    ) -> None: ...

class Char(Message):
    data: int
    def __init__(
        self,
        *,
        data: int = ...,
    ) -> None: ...

class Empty(Message):
    def __init__(self) -> None: ...

class Float32(Message):
    data: float
    def __init__(
        self,
        *,
        data: float = ...,
    ) -> None: ...

class Float32MultiArray(Message):
    layout: MultiArrayLayout
    @property
    def data(self) -> array[float]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        layout: MultiArrayLayout = ...,
        data: ArrayLike = ...,
    ) -> None: ...

class Float64(Message):
    data: float
    def __init__(
        self,
        *,
        data: float = ...,
    ) -> None: ...

class Float64MultiArray(Message):
    layout: MultiArrayLayout
    @property
    def data(self) -> array[float]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        layout: MultiArrayLayout = ...,
        data: ArrayLike = ...,
    ) -> None: ...

class Int16(Message):
    data: int
    def __init__(
        self,
        *,
        data: int = ...,
    ) -> None: ...

class Int16MultiArray(Message):
    layout: MultiArrayLayout
    @property
    def data(self) -> array[int]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        layout: MultiArrayLayout = ...,
        data: ArrayLike = ...,
    ) -> None: ...

class Int32(Message):
    data: int
    def __init__(
        self,
        *,
        data: int = ...,
    ) -> None: ...

class Int32MultiArray(Message):
    layout: MultiArrayLayout
    @property
    def data(self) -> array[int]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        layout: MultiArrayLayout = ...,
        data: ArrayLike = ...,
    ) -> None: ...

class Int64(Message):
    data: int
    def __init__(
        self,
        *,
        data: int = ...,
    ) -> None: ...

class Int64MultiArray(Message):
    layout: MultiArrayLayout
    @property
    def data(self) -> array[int]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        layout: MultiArrayLayout = ...,
        data: ArrayLike = ...,
    ) -> None: ...

class Int8(Message):
    data: int
    def __init__(
        self,
        *,
        data: int = ...,
    ) -> None: ...

class Int8MultiArray(Message):
    layout: MultiArrayLayout
    @property
    def data(self) -> array[int]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        layout: MultiArrayLayout = ...,
        data: ArrayLike = ...,
    ) -> None: ...

class MultiArrayDimension(Message):
    label: str
    size: int
    stride: int
    def __init__(
        self,
        *,
        label: str = ...,
        size: int = ...,
        stride: int = ...,
    ) -> None: ...

class MultiArrayLayout(Message):
    dim: list[MultiArrayDimension]
    data_offset: int
    def __init__(
        self,
        *,
        dim: list[MultiArrayDimension] = ...,
        data_offset: int = ...,
    ) -> None: ...

class String(Message):
    data: str
    def __init__(
        self,
        *,
        data: str = ...,
    ) -> None: ...

class UInt16(Message):
    data: int
    def __init__(
        self,
        *,
        data: int = ...,
    ) -> None: ...

class UInt16MultiArray(Message):
    layout: MultiArrayLayout
    @property
    def data(self) -> array[int]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        layout: MultiArrayLayout = ...,
        data: ArrayLike = ...,
    ) -> None: ...

class UInt32(Message):
    data: int
    def __init__(
        self,
        *,
        data: int = ...,
    ) -> None: ...

class UInt32MultiArray(Message):
    layout: MultiArrayLayout
    @property
    def data(self) -> array[int]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        layout: MultiArrayLayout = ...,
        data: ArrayLike = ...,
    ) -> None: ...

class UInt64(Message):
    data: int
    def __init__(
        self,
        *,
        data: int = ...,
    ) -> None: ...

class UInt64MultiArray(Message):
    layout: MultiArrayLayout
    @property
    def data(self) -> array[int]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        layout: MultiArrayLayout = ...,
        data: ArrayLike = ...,
    ) -> None: ...

class UInt8(Message):
    data: int
    def __init__(
        self,
        *,
        data: int = ...,
    ) -> None: ...

class UInt8MultiArray(Message):
    layout: MultiArrayLayout
    @property
    def data(self) -> array[int]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        layout: MultiArrayLayout = ...,
        data: ArrayLike = ...,
    ) -> None: ...

class WString(Message):
    data: str
    def __init__(
        self,
        *,
        data: str = ...,
    ) -> None: ...
