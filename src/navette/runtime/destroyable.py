"""Base class of entities that can be destroyed."""

from abc import ABC, abstractmethod
from typing import Self

from navette.runtime.handles import HasHandle


class Destroyable(HasHandle, ABC):
    """Base of entities; a ``with`` statement destroys its entity at the end."""

    __slots__ = ()

    @abstractmethod
    def destroy(self) -> None:
        """Leave the graph; the entity cannot be used any more."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc_info: object) -> None:
        self.destroy()
