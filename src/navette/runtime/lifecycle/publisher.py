"""A publisher that is silent while its node is not active."""

from typing import Any, TypeVar

from navette.runtime.lifecycle.managed_entity import SimpleManagedEntity
from navette.runtime.publisher import Publisher

MsgT = TypeVar("MsgT")


class LifecyclePublisher(SimpleManagedEntity, Publisher[MsgT]):
    """Made by ``create_lifecycle_publisher``."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        SimpleManagedEntity.__init__(self)
        Publisher.__init__(self, *args, **kwargs)

    def publish(self, msg: MsgT | bytes) -> None:
        """Send ``msg`` if activated; else do nothing."""
        if self.is_activated:
            super().publish(msg)
