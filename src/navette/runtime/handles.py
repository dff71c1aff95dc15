"""Entity handles, as rclpy's polling interface passes them."""

from typing import Any, Self


class Handle:
    """Reference to an entity; entering and leaving it as a context has no effect."""

    def __init__(self, entity: Any) -> None:
        self.entity = entity

    @property
    def pointer(self) -> int:
        """A number that is unique among living entities."""
        return id(self.entity)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        return


class HasHandle:
    """Base of what has a handle in rclpy; programs pass it on or enter it."""

    __slots__ = ()

    @property
    def handle(self) -> Handle:
        return Handle(self)
