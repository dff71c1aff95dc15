"""The topic half of :class:`Node`, as rclpy has it: publishers and subscriptions."""

from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from navette.errors import NavetteError
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.content_filter import ContentFilterOptions
from navette.runtime.context import Context
from navette.runtime.log import Logger
from navette.runtime.names import NodeRemapper
from navette.runtime.parameter import Parameter
from navette.runtime.publisher import Publisher
from navette.runtime.qos import QoSProfile, as_profile
from navette.runtime.qos_events import (
    EventCallbacks,
    PublisherEventCallbacks,
    SubscriptionEventCallbacks,
)
from navette.runtime.qos_overriding_options import QoSOverridingOptions, overridden
from navette.runtime.qos_watch import EndpointWatch
from navette.runtime.subscription import Subscription
from navette.runtime.type_support import interface_name
from navette.transports import Endpoint, EndpointKind

MsgT = TypeVar("MsgT")


class NodeTopics:
    """Publish and subscribe. Mixed into :class:`Node`."""

    _context: Context
    _remapper: NodeRemapper
    _logger: Logger
    _entities: list[Any]

    def _check_alive(self) -> None:
        raise NotImplementedError

    def has_parameter(self, name: str) -> bool:
        raise NotImplementedError

    def get_parameter(self, name: str) -> Parameter[Any]:
        raise NotImplementedError

    def declare_parameter(
        self, name: str, value: Any = None, descriptor: Any = None
    ) -> Parameter[Any]:
        raise NotImplementedError

    def call_soon(self, function: Callable[[], Any], source: str) -> None:
        raise NotImplementedError

    def _own_group(self, group: CallbackGroup | None) -> CallbackGroup:
        raise NotImplementedError

    def _forget(self, entity: Any) -> None:
        raise NotImplementedError

    def _destroy(self, entity: Any) -> bool:
        raise NotImplementedError

    @property
    def publishers(self) -> Iterator[Publisher[Any]]:
        return (e for e in self._entities if isinstance(e, Publisher))

    @property
    def subscriptions(self) -> Iterator[Subscription[Any]]:
        return (e for e in self._entities if isinstance(e, Subscription))

    def create_publisher(
        self,
        msg_type: type[MsgT],
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: PublisherEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        publisher_class: type[Publisher[Any]] = Publisher,
    ) -> Publisher[MsgT]:
        """A publisher on ``topic`` (relative, private or global; remapped)."""
        kind = EndpointKind.PUBLISHER
        qos = self._profile(kind, topic, qos_profile, qos_overriding_options)
        endpoint = self._endpoint(kind, msg_type, topic, qos)
        watch = self._watch(endpoint, event_callbacks)
        try:
            ports = [
                transport.advertise(endpoint, msg_type)
                for transport in self._context.graph.transports
            ]
        except NavetteError:
            watch.stop()
            raise

        def forget(publisher: Publisher[Any]) -> None:
            watch.stop()
            self._forget(publisher)

        publisher = publisher_class(
            msg_type, endpoint, qos, ports, self._context.loop, forget
        )
        if event_callbacks is not None:
            publisher.event_handlers = event_callbacks.handlers()
        if watch.on_sample is not None:
            publisher.watch(watch.on_sample, watch.on_assertion)
        self._entities.append(publisher)
        return publisher

    def create_subscription(
        self,
        msg_type: type[MsgT],
        topic: str,
        callback: Callable[..., Any],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
        content_filter_options: ContentFilterOptions | None = None,
        shared: bool = False,
    ) -> Subscription[MsgT]:
        """Call ``callback(msg)`` or ``callback(msg, info)`` for every sample.

        Args:
            raw: give the serialised bytes.
            content_filter_options: queue only samples that pass.
            shared: give the one object that all shared subscriptions get, uncopied:
                look, do not alter.
        """
        if not callable(callback):
            raise TypeError(f"topic {topic}: callback {callback!r} is not callable")
        kind = EndpointKind.SUBSCRIPTION
        qos = self._profile(kind, topic, qos_profile, qos_overriding_options)
        endpoint = self._endpoint(kind, msg_type, topic, qos)
        watch = self._watch(endpoint, event_callbacks)

        def forget(subscription: Subscription[Any]) -> None:
            watch.stop()
            self._forget(subscription)

        subscription: Subscription[MsgT] = Subscription(
            msg_type,
            endpoint,
            callback,
            self._own_group(callback_group),
            qos,
            self._context.loop,
            forget,
            raw=raw,
            shared=shared,
        )
        subscription.group.add_entity(subscription)
        self._entities.append(subscription)
        if event_callbacks is not None:
            subscription.event_handlers = event_callbacks.handlers()
        sink = watch.watched(subscription.receive)
        try:
            if content_filter_options is not None:
                subscription.set_content_filter(*content_filter_options)
            for transport in self._context.graph.transports:
                port = transport.subscribe(
                    endpoint, msg_type, sink, shared=shared or raw
                )
                subscription.ports.append(port)
        except NavetteError:
            subscription.destroy()
            raise
        return subscription

    def destroy_publisher(self, publisher: Publisher[Any]) -> bool:
        return self._destroy(publisher)

    def destroy_subscription(self, subscription: Subscription[Any]) -> bool:
        return self._destroy(subscription)

    def _profile(
        self,
        kind: EndpointKind,
        topic: str,
        qos_profile: QoSProfile | int,
        options: QoSOverridingOptions | None,
    ) -> QoSProfile:
        qos = as_profile(qos_profile)
        if options is None:
            return qos
        full_name = self._remapper.resolve(topic)
        return overridden(self, kind.name.lower(), full_name, qos, options)

    def _watch(
        self, endpoint: Endpoint, callbacks: EventCallbacks | None
    ) -> EndpointWatch:
        return EndpointWatch(
            self._context, endpoint, callbacks, self._logger, self.call_soon
        )

    def _endpoint(
        self, kind: EndpointKind, msg_type: type, topic: str, qos: QoSProfile
    ) -> Endpoint:
        self._check_alive()
        endpoint = Endpoint(
            kind=kind,
            topic=self._remapper.resolve(topic),
            type_name=interface_name(msg_type, "msg"),
            qos=qos.to_endpoint_qos(),
            node_name=self._remapper.node_name,
            node_namespace=self._remapper.namespace,
            gid=b"",
        )
        return self._context.graph.with_gid(endpoint)
