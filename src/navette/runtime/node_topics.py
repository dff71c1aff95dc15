"""The topic half of :class:`Node`, as rclpy has it: publishers and subscriptions."""

from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from navette.errors import NavetteError
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.context import Context
from navette.runtime.log import Logger
from navette.runtime.names import NodeRemapper
from navette.runtime.publisher import Publisher
from navette.runtime.qos import QoSProfile, as_profile
from navette.runtime.qos_events import (
    PublisherEventCallbacks,
    SubscriptionEventCallbacks,
    watch_endpoint,
)
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
        publisher_class: type[Publisher[Any]] = Publisher,
    ) -> Publisher[MsgT]:
        """A publisher on ``topic`` (relative, private or global; remapped)."""
        qos = as_profile(qos_profile)
        endpoint = self._endpoint(EndpointKind.PUBLISHER, msg_type, topic, qos)
        undo = watch_endpoint(
            self._context, endpoint, event_callbacks, self._logger, self.call_soon
        )
        try:
            ports = [
                transport.advertise(endpoint, msg_type)
                for transport in self._context.graph.transports
            ]
        except NavetteError:
            undo()
            raise

        def forget(publisher: Publisher[Any]) -> None:
            undo()
            self._forget(publisher)

        publisher = publisher_class(
            msg_type, endpoint, qos, ports, self._context.loop, forget
        )
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
        raw: bool = False,
        shared: bool = False,
    ) -> Subscription[MsgT]:
        """Call ``callback(msg)`` or ``callback(msg, info)`` for every sample.

        Args:
            raw: give the serialised bytes.
            shared: give the one object that all shared subscriptions get, uncopied:
                look, do not alter.
        """
        if not callable(callback):
            raise TypeError(f"topic {topic}: callback {callback!r} is not callable")
        qos = as_profile(qos_profile)
        endpoint = self._endpoint(EndpointKind.SUBSCRIPTION, msg_type, topic, qos)
        undo = watch_endpoint(
            self._context, endpoint, event_callbacks, self._logger, self.call_soon
        )

        def forget(subscription: Subscription[Any]) -> None:
            undo()
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
        try:
            for transport in self._context.graph.transports:
                port = transport.subscribe(
                    endpoint, msg_type, subscription.receive, shared=shared or raw
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

    def _endpoint(
        self, kind: EndpointKind, msg_type: type, topic: str, qos: QoSProfile
    ) -> Endpoint:
        self._check_alive()
        return Endpoint(
            kind=kind,
            topic=self._remapper.resolve(topic),
            type_name=interface_name(msg_type, "msg"),
            qos=qos.to_endpoint_qos(),
            node_name=self._remapper.node_name,
            node_namespace=self._remapper.namespace,
            gid=self._context.graph.new_gid(),
        )
