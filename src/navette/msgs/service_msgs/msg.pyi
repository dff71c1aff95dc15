# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from typing import ClassVar

import numpy as np

from numpy.typing import ArrayLike, NDArray

from navette.msgs.base import Message
import navette.msgs.builtin_interfaces.msg

class ServiceEventInfo(Message):
    REQUEST_SENT: ClassVar[int]
    REQUEST_RECEIVED: ClassVar[int]
    RESPONSE_SENT: ClassVar[int]
    RESPONSE_RECEIVED: ClassVar[int]
    event_type: int
    stamp: navette.msgs.builtin_interfaces.msg.Time
    @property
    def client_gid(self) -> NDArray[np.uint8]: ...
    @client_gid.setter
    def client_gid(self, value: ArrayLike) -> None: ...
    sequence_number: int
    def __init__(
        self,
        *,
        event_type: int = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
        client_gid: ArrayLike = ...,
        sequence_number: int = ...,
    ) -> None: ...
