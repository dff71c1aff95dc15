"""Filters call back with what comes out of them; a subscriber is the first of a chain.

The names of methods are those of ROS's package.
"""

# ruff: noqa: N802 - the names are message_filters'

from collections.abc import Callable
from typing import Any

from navette.runtime import Clock, Node, ROSClock, Subscription


class SimpleFilter:
    """Anything with output: others connect to it by :meth:`registerCallback`."""

    #: Tells the time of messages without a stamp; None where no node is known.
    clock: Clock | None = None

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callable[..., Any], tuple[Any, ...]]] = {}

    def registerCallback(self, cb: Callable[..., Any], *args: Any) -> int:
        """Call ``cb(*messages, *args)`` for each output; the connection's number."""
        connection = len(self.callbacks)
        self.callbacks[connection] = (cb, args)
        return connection

    def signalMessage(self, *msg: Any) -> None:
        """Hand an output on to those who are connected, in their order."""
        for callback, args in tuple(self.callbacks.values()):
            callback(*msg, *args)


class Subscriber(SimpleFilter):
    """Takes what :meth:`Node.create_subscription` takes, but for the callback.

    Everything a subscription has is reached through it, too.

    Args:
        node: whose subscription it is.
        msg_type, topic: as for ``create_subscription``.
        qos_profile: profile or depth.
    """

    def __init__(
        self,
        node: Node,
        msg_type: type,
        topic: str,
        qos_profile: Any = 10,
        **kwargs: Any,
    ) -> None:
        super().__init__()
        self.node = node
        self.topic = topic
        self.clock = node.get_clock()
        self.sub: Subscription[Any] = node.create_subscription(
            msg_type, topic, self.callback, qos_profile, **kwargs
        )

    def callback(self, msg: Any) -> None:
        """A message arrived."""
        self.signalMessage(msg)

    def getTopic(self) -> str:
        return self.topic

    def __getattr__(self, key: str) -> Any:
        if key == "sub":  # not made yet: the node refused it
            raise AttributeError(key)
        return getattr(self.sub, key)


def clock_of(*filters: Any) -> Clock:
    """The clock of the first that has one; else the default context's."""
    for each in filters:
        clock = getattr(each, "clock", None)
        if isinstance(clock, Clock):
            return clock
    return ROSClock()
