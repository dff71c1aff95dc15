"""What a node has besides topics, services and timers: actions, for one."""

from typing import Any

from navette.runtime.callback_groups import CallbackGroup


class Waitable:
    """Base of the things that :meth:`Node.add_waitable` takes.

    In rclpy a waitable adds handles to the executor's wait set. There is no wait set
    here: a waitable is put together from services, topics and calls, which the loop
    runs; the node keeps it and destroys it with itself.
    """

    def __init__(self, callback_group: CallbackGroup) -> None:
        self.callback_group = callback_group
        callback_group.add_entity(self)

    def destroy(self) -> None:
        """Take down what it is put together from."""

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()
