"""Subscriptions: a queue of the newest samples, and a callback."""

from collections import deque
from collections.abc import Callable, Sequence
from enum import Enum
from typing import Any, Generic, NamedTuple, TypedDict, TypeVar

from navette.msgs import serialize
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.destroyable import Destroyable
from navette.runtime.events import Entity
from navette.runtime.handles import Handle
from navette.runtime.node_entities import NodeEntities
from navette.runtime.qos import QoSProfile
from navette.runtime.qos_events import EventHandler
from navette.runtime.qos_watch import EndpointWatch
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


class SubscriptionHandle(Handle):
    """Handle of a subscription, for polling."""

    entity: "Subscription[Any]"

    def take_message(
        self, msg_type: type, raw: bool
    ) -> "tuple[Any, MessageInfo] | None":
        """Remove and return the oldest queued sample (bytes if ``raw``), or None."""
        return self.entity.take_with_info(raw=raw)


class ContentFilterOptions(NamedTuple):
    """Filter expression of a subscription, and the values of ``%0``, ``%1``, … as text.

    See :func:`navette.runtime.filter_expression.compile_filter`.
    """

    filter_expression: str
    expression_parameters: list[str]


class MessageInfo(TypedDict):
    """Second argument of a callback: stamps (ns) and sequence numbers of a sample."""

    source_timestamp: int
    received_timestamp: int
    publication_sequence_number: int | None
    reception_sequence_number: int | None


class Subscription(Destroyable, Entity, Generic[MsgT]):
    """Runs a callback for each sample. Created by :meth:`Node.create_subscription`."""

    class CallbackType(Enum):
        """Whether the callback takes a :class:`MessageInfo`."""

        MessageOnly = 0
        WithMessageInfo = 1

    __slots__ = (
        "_callback",
        "_direct_limit",
        "_entities",
        "_events",
        "_filter",
        "_filter_options",
        "_loop",
        "_plain",
        "_queue",
        "_ready",
        "_received",
        "_takes_info",
        "_watch",
        "endpoint",
        "event_handlers",
        "msg_type",
        "on_undecodable",
        "ports",
        "qos_profile",
        "raw",
        "runs_during_calls",
        "shared",
    )

    def __init__(
        self,
        msg_type: type[MsgT],
        endpoint: Endpoint,
        callback: Callable[..., Any],
        *,
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
        entities: NodeEntities,
        watch: EndpointWatch,
        raw: bool = False,
        shared: bool = False,
    ) -> None:
        self.msg_type = msg_type
        self.endpoint = endpoint
        self.group = callback_group
        self.qos_profile = qos_profile
        self.raw = raw
        self.shared = shared
        self.runs_during_calls = False
        #: Called for each sample that cannot be decoded; the transport logs it.
        self.on_undecodable: Callable[[], None] | None = None
        self.ports: list[SubscriptionPort] = []
        self.event_handlers: list[EventHandler] = watch.event_handlers
        # Number of samples queued without inspection; 0 with a content filter.
        self._direct_limit = endpoint.qos.queue_length or INFINITE_NS
        self._filter: Callable[[Any], bool] | None = None
        self._filter_options = ContentFilterOptions("", [])
        self._queue: deque[Item] = deque(maxlen=endpoint.qos.queue_length)
        self._loop = entities.context.loop
        self._ready = self._loop.ready
        # One entry for each event that waits: threads add and remove them safely.
        self._events: deque[None] = deque()
        self._received = 0
        self._entities = entities
        self._watch = watch
        self.callback = callback

    @property
    def callback(self) -> Callable[..., Any]:
        return self._callback

    @callback.setter
    def callback(self, callback: Callable[..., Any]) -> None:
        self._callback = callback
        self._takes_info = takes_arguments(callback, 2)
        self._plain = not self.raw and not self._takes_info

    @property
    def callback_group(self) -> CallbackGroup:
        return self.group

    @property
    def topic_name(self) -> str:
        return self.endpoint.topic

    @property
    def topic(self) -> str:
        return self.endpoint.topic

    def get_publisher_count(self) -> int:
        """Return the number of matched publishers."""
        return sum(port.matched_count for port in self.ports)

    def limit_rate(self, most_hz: float) -> None:
        """Tell the publishers that the last message of each period is enough.

        Not a filter: see :meth:`Publisher.is_used`. Infinite: every message is used.
        """
        for port in self.ports:
            port.most_hz = most_hz

    @property
    def is_cft_enabled(self) -> bool:
        """Whether a content filter is set."""
        return self._filter is not None

    def get_content_filter(self) -> ContentFilterOptions:
        """Return the content filter; an empty expression means no filter."""
        return self._filter_options

    def set_content_filter(
        self, filter_expression: str, expression_parameters: Sequence[str] = ()
    ) -> None:
        """Queue only samples for which the expression is true; all if it is empty.

        Raises:
            ContentFilterError: the expression or a parameter is not valid.
        """
        parameters = list(expression_parameters)
        passes: Callable[[Any], bool] | None = None
        if filter_expression:
            from navette.runtime.filter_expression import compile_filter

            passes = compile_filter(filter_expression, parameters, self.msg_type)
        self._filter_options = ContentFilterOptions(filter_expression, parameters)
        self._filter = passes
        self._direct_limit = 0 if passes else self._queue.maxlen or INFINITE_NS

    def _passes(self, message: Any, passes: Callable[[Any], bool]) -> bool:
        message = self._unwrapped(message)
        return message is not None and passes(message)

    def receive(self, item: Item) -> None:
        """Queue a sample (the transport's sink); a full queue drops its oldest."""
        queue = self._queue
        if len(queue) < self._direct_limit:
            queue.append(item)
            self._events.append(None)
            self._ready.append(self)
            if self._loop.waiting:
                self._loop.wake()
        elif self._filter is None or self._passes(item[0], self._filter):
            self._replace_oldest(item)

    def _replace_oldest(self, item: Item) -> None:
        """Queue a sample that passed the filter or finds the queue full."""
        queue = self._queue
        queue.append(item)  # drops the oldest of a full queue in the same step
        # If it dropped one, this sample has the event of that one, unless a driving
        # thread has just taken it. An event more has no effect, but one for each sample
        # would hold up all other callbacks.
        if len(self._events) < len(queue):
            self._events.append(None)
            self._ready.append(self)
            if self._loop.waiting:
                self._loop.wake()

    def run(self) -> Any:
        """Run the callback with the oldest queued sample."""
        try:
            self._events.pop()
            item = self._queue.popleft()
        except IndexError:  # destroyed while the event was queued, or one more event
            return None
        if self._plain:
            message = item[0]
            kind = message.__class__
            if kind is Encoded or kind is Expiring:
                message = self._unwrapped(message)
                if message is None:
                    return None
            return self._callback(message)
        return self._run_with_info(item)

    def take(self) -> MsgT | None:
        """Remove and return the oldest queued sample; None if the queue is empty."""
        while self._queue:
            message = self._unwrapped(self._queue.popleft()[0])
            if message is not None:
                taken: MsgT = message
                return taken
        return None

    @property
    def has_samples(self) -> bool:
        """Whether samples are queued."""
        return bool(self._queue)

    def take_with_info(self, *, raw: bool = False) -> tuple[Any, MessageInfo] | None:
        """As :meth:`take`, with the sample's info; the serialised bytes if ``raw``."""
        while self._queue:
            item = self._queue.popleft()
            message = self._opened(item[0], raw=raw)
            if message is not None:
                return message, self._info_of(item)
        return None

    @property
    def handle(self) -> SubscriptionHandle:
        """Handle for polling with rclpy's internal wait set."""
        return SubscriptionHandle(self)

    def origin(self) -> tuple[str, str]:
        return self.endpoint.node_full_name, f"topic {self.endpoint.topic}"

    def destroy(self) -> None:
        """Leave the topic and drop the queued samples."""
        for port in self.ports:
            port.close()
        self._queue.clear()
        self._watch.stop()
        self._entities.forget(self)

    def _unwrapped(self, message: Any) -> Any:
        """Return the message; None if it expired or cannot be decoded."""
        if message.__class__ is Expiring:
            message = message.at(self._loop.clock.now_ns)
        if message.__class__ is not Encoded:
            return message
        decoded = message.decode()
        if decoded is None and self.on_undecodable is not None:
            self.on_undecodable()
        return decoded

    def _opened(self, message: Any, *, raw: bool) -> Any:
        """Return the message or its bytes; None if it expired or cannot be decoded."""
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
        if not self._takes_info:
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
