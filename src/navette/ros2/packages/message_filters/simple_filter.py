"""Base of filters, which pass messages to callbacks, and the subscriber filter.

The names of methods are those of ROS's package.
"""

# ruff: noqa: N802 - the names are message_filters'

from collections.abc import Callable
from typing import Any

from navette.runtime import Clock, Node, ROSClock, Subscription


class SimpleFilter:
    """Filter whose output goes to the callbacks of :meth:`registerCallback`."""

    #: Clock for messages without a stamp; None if the filter has no node.
    clock: Clock | None = None

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callable[..., Any], tuple[Any, ...]]] = {}

    def registerCallback(self, cb: Callable[..., Any], *args: Any) -> int:
        """Call ``cb(*messages, *args)`` for each output; return the connection."""
        connection = len(self.callbacks)
        self.callbacks[connection] = (cb, args)
        return connection

    def signalMessage(self, *msg: Any) -> None:
        """Pass an output to the callbacks in the order of their registration."""
        for callback, args in tuple(self.callbacks.values()):
            callback(*msg, *args)


class Subscriber(SimpleFilter):
    """Filter whose input is a subscription; has the subscription's attributes too.

    The arguments are those of ``node.create_subscription``.
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
        self.signalMessage(msg)

    def getTopic(self) -> str:
        return self.topic

    def __getattr__(self, key: str) -> Any:
        if key == "sub":  # create_subscription raised
            raise AttributeError(key)
        return getattr(self.sub, key)


def clock_of(*filters: Any) -> Clock:
    """Return the clock of the first filter that has one, or the default context's."""
    for each in filters:
        clock = getattr(each, "clock", None)
        if isinstance(clock, Clock):
            return clock
    return ROSClock()
