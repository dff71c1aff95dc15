"""Subscriptions: a queue of the newest samples and a callback."""

from collections import deque
from collections.abc import Callable, Sequence
from enum import Enum
from typing import Any, Generic, TypedDict, TypeVar

from navette.msgs import serialize
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.content_filter import ContentFilterOptions
from navette.runtime.destroyable import Destroyable
from navette.runtime.events import Entity
from navette.runtime.handles import SubscriptionHandle
from navette.runtime.loop import EventLoop
from navette.runtime.qos import QoSProfile
from navette.runtime.qos_events import EventHandler
from navette.runtime.signatures import takes_arguments
from navette.transports import (
    INFINITE_NS,
    Encoded,
    Endpoint,
    Expiring,
    Item,
    SubscriptionPort,
)

MsgT = TypeVar("MsgT")


class MessageInfo(TypedDict):
    """What a callback's second argument tells about the sample; stamps in ns."""

    source_timestamp: int
    received_timestamp: int
    publication_sequence_number: int | None
    reception_sequence_number: int | None


class Subscription(Destroyable, Entity, Generic[MsgT]):
    """Calls back for each sample. Made by :meth:`Node.create_subscription`."""

    class CallbackType(Enum):
        """Whether the callback wants the :class:`MessageInfo`."""

        MessageOnly = 0
        WithMessageInfo = 1

    __slots__ = (
        "_callback",
        "_filter",
        "_filter_options",
        "_informed",
        "_loop",
        "_on_destroy",
        "_plain",
        "_queue",
        "_ready",
        "_received",
        "_room",
        "answers_calls",
        "endpoint",
        "event_handlers",
        "msg_type",
        "ports",
        "qos_profile",
        "raw",
        "shared",
    )

    def __init__(
        self,
        msg_type: type[MsgT],
        endpoint: Endpoint,
        callback: Callable[..., Any],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
        loop: EventLoop,
        on_destroy: Callable[["Subscription[Any]"], None],
        *,
        raw: bool = False,
        shared: bool = False,
    ) -> None:
        self.msg_type = msg_type
        self.endpoint = endpoint
        self.group = callback_group
        self.qos_profile = qos_profile
        self.raw = raw
        self.shared = shared
        self.answers_calls = False
        self.ports: list[SubscriptionPort] = []
        #: What it calls back for.
        self.event_handlers: list[EventHandler] = []
        #: How many samples may wait; 0 where each has to be looked at first.
        self._room = endpoint.qos.queue_length or INFINITE_NS
        self._filter: Callable[[Any], bool] | None = None
        self._filter_options = ContentFilterOptions("", [])
        self._queue: deque[Item] = deque(maxlen=endpoint.qos.queue_length)
        self._loop = loop
        self._ready = loop.ready
        self._received = 0
        self._on_destroy = on_destroy
        self.callback = callback

    @property
    def callback(self) -> Callable[..., Any]:
        return self._callback

    @callback.setter
    def callback(self, callback: Callable[..., Any]) -> None:
        self._callback = callback
        self._informed = takes_arguments(callback, 2)
        self._plain = not self.raw and not self._informed

    @property
    def topic_name(self) -> str:
        return self.endpoint.topic

    @property
    def topic(self) -> str:
        return self.endpoint.topic

    def get_publisher_count(self) -> int:
        """How many publishers are heard."""
        return sum(port.matched_count for port in self.ports)

    # -- content filter --------------------------------------------------------

    @property
    def is_cft_enabled(self) -> bool:
        """Whether a content filter is set."""
        return self._filter is not None

    def get_content_filter(self) -> ContentFilterOptions:
        """The filter that is set; an empty expression is none."""
        return self._filter_options

    def set_content_filter(
        self, filter_expression: str, expression_parameters: Sequence[str] = ()
    ) -> None:
        """Queue only samples for which the expression holds; empty: all.

        Raises:
            ContentFilterError: the expression or a parameter cannot be used.
        """
        parameters = list(expression_parameters)
        wanted: Callable[[Any], bool] | None = None
        if filter_expression:
            from navette.runtime.filter_expression import compile_filter

            wanted = compile_filter(filter_expression, parameters, self.msg_type)
        self._filter_options = ContentFilterOptions(filter_expression, parameters)
        self._filter = wanted
        self._room = 0 if wanted else self._queue.maxlen or INFINITE_NS

    def _passes(self, message: Any, wanted: Callable[[Any], bool]) -> bool:
        message = self._unwrapped(message)
        return message is not None and wanted(message)

    # -- inside ----------------------------------------------------------------

    def receive(self, item: Item) -> None:
        """Queue a sample (the transport's sink); a full queue loses its oldest."""
        queue = self._queue
        if len(queue) < self._room:
            queue.append(item)
            self._ready.append(self)
            if self._loop.waiting:
                self._loop.wake()
        elif self._filter is None or self._passes(item[0], self._filter):
            self._receive_slowly(item)

    def _receive_slowly(self, item: Item) -> None:
        """Into a queue that is full, or behind a filter."""
        queue = self._queue
        is_full = len(queue) == queue.maxlen
        queue.append(item)  # and the oldest falls out of a full one, in one step
        # Another thread that drives may have taken a sample just before: then the
        # queue was not full, and this one needs an event. One too many is harmless.
        if not is_full or self._loop.is_driven_elsewhere:
            self._ready.append(self)
            if self._loop.waiting:
                self._loop.wake()

    def run(self) -> Any:
        """Call back with the oldest sample of the queue."""
        queue = self._queue
        if not queue:  # destroyed while the event waited, or one event too many
            return None
        if self._plain:
            message = queue.popleft()[0]
            kind = message.__class__
            if kind is Encoded or kind is Expiring:
                message = self._unwrapped(message)
                if message is None:
                    return None
            return self._callback(message)
        return self._run_with_info(queue.popleft())

    def take(self) -> MsgT | None:
        """The oldest sample of the queue, without a callback; None if it is empty."""
        while self._queue:
            message = self._unwrapped(self._queue.popleft()[0])
            if message is not None:
                taken: MsgT = message
                return taken
        return None

    @property
    def has_samples(self) -> bool:
        """Whether something waits in the queue."""
        return bool(self._queue)

    def take_with_info(self, *, raw: bool = False) -> tuple[Any, MessageInfo] | None:
        """As :meth:`take`, with what is known of the sample; its bytes if ``raw``."""
        while self._queue:
            item = self._queue.popleft()
            message = self._opened(item[0], raw=raw)
            if message is not None:
                return message, self._info_of(item)
        return None

    @property
    def handle(self) -> SubscriptionHandle:
        """To poll by, as rclpy's inside does."""
        return SubscriptionHandle(self)

    def origin(self) -> tuple[str, str]:
        return self.endpoint.node_full_name, f"topic {self.endpoint.topic}"

    def destroy(self) -> None:
        """Leave the topic and forget what is queued."""
        for port in self.ports:
            port.close()
        self._queue.clear()
        self._on_destroy(self)

    def _unwrapped(self, message: Any) -> Any:
        """The message itself; None if it expired or is not what it should be."""
        if message.__class__ is Expiring:
            message = message.at(self._loop.clock.now_ns)
        return message.decode() if message.__class__ is Encoded else message

    def _opened(self, message: Any, *, raw: bool) -> Any:
        """The message or its bytes; None if it expired or is not what it should be."""
        if not raw:
            return self._unwrapped(message)
        if message.__class__ is Expiring:
            message = message.at(self._loop.clock.now_ns)
        if message is None:
            return None
        return message.data if message.__class__ is Encoded else serialize(message)

    def _run_with_info(self, item: Item) -> Any:
        message = self._opened(item[0], raw=self.raw)
        if message is None:
            return None
        info = self._info_of(item)
        if not self._informed:
            return self._callback(message)
        return self._callback(message, info)

    def _info_of(self, item: Item) -> MessageInfo:
        _, source_ns, received_ns, sequence = item
        self._received += 1
        return {
            "source_timestamp": source_ns,
            "received_timestamp": received_ns,
            "publication_sequence_number": sequence,
            "reception_sequence_number": self._received,
        }
