"""The in-process transport: a topic table, at most one copy for each delivery."""

import math
import threading
from collections import deque
from collections.abc import Callable
from typing import Any

from navette.errors import InvalidValueError
from navette.msgs import copy_message
from navette.transports.base import (
    Endpoint,
    EndpointKind,
    Item,
    PublisherPort,
    Sink,
    SubscriptionPort,
    Transport,
    TransportObserver,
)
from navette.transports.encoded import Encoded
from navette.transports.expiring import Expiring
from navette.transports.inprocess_services import (
    InProcessClient,
    InProcessService,
    ServiceTable,
)
from navette.transports.qos import INFINITE_NS, incompatible_policies
from navette.transports.service_ports import ReplySink, RequestSink


class InProcessPublisher(PublisherPort):
    """Calls the sinks of the matched subscriptions, in order of matching."""

    def __init__(self, endpoint: Endpoint, transport: "InProcessTransport") -> None:
        self.endpoint = endpoint
        self._transport = transport
        self._lifespan_ns = endpoint.qos.lifespan_ns
        # Tuples, replaced as a whole: a publishing thread sees no partial change.
        self._subscriptions: tuple[InProcessSubscription, ...] = ()
        self._sinks: tuple[Sink, ...] = ()
        self._shared_sinks: tuple[Sink, ...] = ()
        self._joining = threading.Lock()  # the history is read, or added to
        self._history: deque[Item] | None = None
        if endpoint.qos.is_latched:
            self._history = deque(maxlen=endpoint.qos.queue_length)

    def send(self, message: Any, source_ns: int, sequence: int) -> None:
        self._deliver(message, source_ns, sequence)

    def hand_over(self, message: Any, source_ns: int, sequence: int) -> None:
        self._deliver(message, source_ns, sequence, is_final=True)

    def _deliver(
        self, message: Any, source_ns: int, sequence: int, *, is_final: bool = False
    ) -> None:
        copied: Callable[[Any], Any] = copy_message
        if self._lifespan_ns < INFINITE_NS:
            message, copied = Expiring(message, source_ns + self._lifespan_ns), _copied
        elif message.__class__ is Encoded:
            copied = _copied
        sinks, shared_sinks = self._sinks, self._shared_sinks
        if shared_sinks or self._history is not None:
            # One copy for all readers, unless the caller cannot change its own later.
            shared = message if is_final else copied(message)
            item = (shared, source_ns, source_ns, sequence)
            if self._history is not None:
                sinks, shared_sinks = self._store(item)
        for sink in sinks:
            sink((copied(message), source_ns, source_ns, sequence))
        for sink in shared_sinks:
            sink(item)

    def _store(self, item: Item) -> tuple[tuple[Sink, ...], tuple[Sink, ...]]:
        """Add a latched sample; return the sinks of earlier readers."""
        assert self._history is not None
        with self._joining:
            self._history.append(item)
            return self._sinks, self._shared_sinks

    def link(
        self,
        subscriptions: "list[InProcessSubscription]",
        late: "InProcessSubscription",
    ) -> None:
        """Replace the matched subscriptions, to which a late joiner was added.

        It receives each latched sample once, also while one is published.
        """
        with self._joining:
            self.relink(subscriptions)
            self._replay(late)

    def relink(self, subscriptions: "list[InProcessSubscription]") -> None:
        """Replace the matched subscriptions."""
        self._subscriptions = tuple(subscriptions)
        self._sinks = tuple(s.sink for s in subscriptions if not s.shared)
        self._shared_sinks = tuple(s.sink for s in subscriptions if s.shared)

    def _replay(self, subscription: "InProcessSubscription") -> None:
        """Deliver the newest latched samples to a late joiner, oldest first."""
        if self._history is None or not subscription.endpoint.qos.is_latched:
            return
        wanted = subscription.endpoint.qos.queue_length
        for item in list(self._history)[-wanted if wanted else 0 :]:
            if subscription.shared:
                subscription.sink(item)
            else:
                subscription.sink((_copied(item[0]), *item[1:]))

    @property
    def matched_count(self) -> int:
        return len(self._sinks) + len(self._shared_sinks)

    @property
    def most_hz(self) -> float:
        rates = {subscription.most_hz for subscription in self._subscriptions}
        return rates.pop() if len(rates) == 1 else math.inf

    def close(self) -> None:
        self._transport.remove_publisher(self)


def _copied(message: Any) -> Any:
    """Return a copy for one receiver; bytes are shared."""
    if message.__class__ is Encoded:
        return message
    if message.__class__ is Expiring:
        return Expiring(_copied(message.message), message.expires_ns)
    return copy_message(message)


class InProcessSubscription(SubscriptionPort):
    """Holds the sink that the matched publishers call."""

    def __init__(
        self,
        endpoint: Endpoint,
        transport: "InProcessTransport",
        *,
        sink: Sink,
        shared: bool,
    ) -> None:
        self.endpoint = endpoint
        self.sink = sink
        self.shared = shared
        self._transport = transport

    @property
    def matched_count(self) -> int:
        return self._transport.count_publishers_of(self)

    def close(self) -> None:
        self._transport.remove_subscription(self)


class _Topic:
    """Endpoints of one topic name and type."""

    def __init__(self) -> None:
        self.publishers: list[InProcessPublisher] = []
        self.subscriptions: list[InProcessSubscription] = []

    def ports(self) -> "list[InProcessPublisher | InProcessSubscription]":
        return [*self.publishers, *self.subscriptions]

    def matches(self, publisher: InProcessPublisher) -> "list[InProcessSubscription]":
        return [s for s in self.subscriptions if _is_compatible(publisher, s)]


def _key(endpoint: Endpoint) -> tuple[str, str]:
    return endpoint.topic, endpoint.type_name


def _is_compatible(
    publisher: InProcessPublisher, subscription: InProcessSubscription
) -> bool:
    ends = publisher.endpoint, subscription.endpoint
    return not (incompatible_policies(ends[0].qos, ends[1].qos) or _is_ignored(*ends))


def _is_ignored(publisher: Endpoint, subscription: Endpoint) -> bool:
    if not subscription.ignores_own_node:
        return False
    return publisher.node_full_name == subscription.node_full_name


class InProcessTransport(Transport):
    """Topic table of one context; safe to use from several threads."""

    def __init__(self) -> None:
        #: By name and type.
        self._topics: dict[tuple[str, str], _Topic] = {}
        self._types: dict[str, list[str]] = {}  # of each topic
        self._observers: list[TransportObserver] = []
        self._lock = threading.RLock()
        self._services = ServiceTable(self._lock, on_change=self._changed)

    def observe(self, observer: TransportObserver) -> None:
        self._observers.append(observer)

    def advertise(self, endpoint: Endpoint, message_class: type) -> InProcessPublisher:
        with self._lock:
            topic = self._topic_for(endpoint)
            publisher = InProcessPublisher(endpoint, self)
            topic.publishers.append(publisher)
            publisher.relink(topic.matches(publisher))
            self._report_matches(
                [(publisher, subscription) for subscription in topic.subscriptions]
            )
        return publisher

    def subscribe(
        self, endpoint: Endpoint, message_class: type, sink: Sink, *, shared: bool
    ) -> InProcessSubscription:
        with self._lock:
            topic = self._topic_for(endpoint)
            subscription = InProcessSubscription(
                endpoint, self, sink=sink, shared=shared
            )
            topic.subscriptions.append(subscription)
            for publisher in topic.publishers:
                if _is_compatible(publisher, subscription):
                    publisher.link(topic.matches(publisher), subscription)
            self._report_matches(
                [(publisher, subscription) for publisher in topic.publishers]
            )
        return subscription

    def serve(self, endpoint: Endpoint, sink: RequestSink) -> InProcessService:
        return self._services.serve(endpoint, sink)

    def connect(self, endpoint: Endpoint, sink: ReplySink) -> InProcessClient:
        return self._services.connect(endpoint, sink)

    def remove_publisher(self, publisher: InProcessPublisher) -> None:
        with self._lock:
            topic = self._topics.get(_key(publisher.endpoint))
            if topic is None or publisher not in topic.publishers:
                return
            topic.publishers.remove(publisher)
            matched = topic.matches(publisher)
            publisher.relink([])
            self._remove_if_empty(publisher.endpoint, topic)
            for subscription in matched:
                for observer in self._observers:
                    observer.unmatched(publisher.endpoint, subscription.endpoint)
            self._changed()

    def remove_subscription(self, subscription: InProcessSubscription) -> None:
        with self._lock:
            topic = self._topics.get(_key(subscription.endpoint))
            if topic is None or subscription not in topic.subscriptions:
                return
            topic.subscriptions.remove(subscription)
            for publisher in topic.publishers:
                publisher.relink(topic.matches(publisher))
                if _is_compatible(publisher, subscription):
                    for observer in self._observers:
                        observer.unmatched(publisher.endpoint, subscription.endpoint)
            self._remove_if_empty(subscription.endpoint, topic)
            self._changed()

    def count_publishers_of(self, subscription: InProcessSubscription) -> int:
        topic = self._topics.get(_key(subscription.endpoint))
        if topic is None or subscription not in topic.subscriptions:
            return 0
        return sum(
            _is_compatible(publisher, subscription) for publisher in topic.publishers
        )

    def endpoints(self, topic: str | None = None) -> list[Endpoint]:
        with self._lock:
            if topic is None:
                chosen = list(self._topics.values())
            else:
                types = self._types.get(topic, ())
                chosen = [self._topics[topic, each] for each in types]
            return [port.endpoint for each in chosen for port in each.ports()]

    def service_endpoints(self) -> list[Endpoint]:
        return [port.endpoint for port in self._services.ports()]

    def close(self) -> None:
        with self._lock:
            topics = list(self._topics.values())
        for topic in topics:
            for port in topic.ports():
                port.close()
        for service_port in self._services.ports():
            service_port.close()

    def _topic_for(self, endpoint: Endpoint) -> _Topic:
        topic = self._topics.get(_key(endpoint))
        if topic is None:
            self._check_type(endpoint)
            topic = self._topics[_key(endpoint)] = _Topic()
            self._types.setdefault(endpoint.topic, []).append(endpoint.type_name)
        return topic

    def _check_type(self, endpoint: Endpoint) -> None:
        """Raise if the topic has another type, without an endpoint of this one."""
        other = {
            type_name: self._topics[endpoint.topic, type_name]
            for type_name in self._types.get(endpoint.topic, ())
            if type_name not in endpoint.other_types
        }
        for type_name, topic in other.items():
            nodes = sorted({port.endpoint.node_full_name for port in topic.ports()})
            verb = (
                "publish" if endpoint.kind == EndpointKind.PUBLISHER else "subscribe to"
            )
            raise InvalidValueError(
                f"topic {endpoint.topic} has the type {type_name} "
                f"({', '.join(nodes)}); node {endpoint.node_full_name} cannot {verb} "
                f"{endpoint.type_name} on it"
            )

    def _report_matches(
        self, pairs: list[tuple[InProcessPublisher, InProcessSubscription]]
    ) -> None:
        for publisher, subscription in pairs:
            ends = publisher.endpoint, subscription.endpoint
            policies = incompatible_policies(ends[0].qos, ends[1].qos)
            for observer in () if _is_ignored(*ends) else self._observers:
                if policies:
                    observer.incompatible_qos(*ends, policies)
                else:
                    observer.matched(*ends)
        self._changed()

    def _remove_if_empty(self, endpoint: Endpoint, topic: _Topic) -> None:
        if not topic.publishers and not topic.subscriptions:
            del self._topics[_key(endpoint)]
            types = self._types[endpoint.topic]
            types.remove(endpoint.type_name)
            if not types:
                del self._types[endpoint.topic]

    def _changed(self) -> None:
        for observer in self._observers:
            observer.graph_changed()
