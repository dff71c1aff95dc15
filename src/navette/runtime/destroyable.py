"""What can be destroyed, and is at the end of a ``with``."""

from abc import ABC, abstractmethod
from types import TracebackType
from typing import Self


class Destroyable(ABC):
    """``with node.create_subscription(…): …`` destroys it at the end."""

    __slots__ = ()

    @abstractmethod
    def destroy(self) -> None:
        """Leave for good."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        exc_type: type[BaseException] | None,
        exc_val: BaseException | None,
        exc_tb: TracebackType | None,
    ) -> None:
        self.destroy()
