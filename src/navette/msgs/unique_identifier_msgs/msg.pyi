# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

import numpy as np

from numpy.typing import ArrayLike, NDArray

from navette.msgs.base import Message

class UUID(Message):
    @property
    def uuid(self) -> NDArray[np.uint8]: ...
    @uuid.setter
    def uuid(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        uuid: ArrayLike = ...,
    ) -> None: ...
