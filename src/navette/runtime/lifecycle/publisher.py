"""Publisher of a managed node."""

from typing import Any, TypeVar

from navette.runtime.lifecycle.managed_entity import SimpleManagedEntity
from navette.runtime.publisher import Publisher

MsgT = TypeVar("MsgT")


class LifecyclePublisher(SimpleManagedEntity, Publisher[MsgT]):
    """Publisher that publishes only while its node is active.

    ``create_lifecycle_publisher`` creates it.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        SimpleManagedEntity.__init__(self)
        Publisher.__init__(self, *args, **kwargs)

    def publish(self, msg: MsgT | bytes) -> None:
        if self.is_activated:
            super().publish(msg)
