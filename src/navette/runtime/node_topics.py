"""Create a node's publishers and subscriptions."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, TypeVar

from navette.errors import NavetteError
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.exceptions import CallbackSignatureError
from navette.runtime.log import Logger
from navette.runtime.node_entities import NodeEntities
from navette.runtime.node_parameters import NodeParameters
from navette.runtime.publisher import Publisher
from navette.runtime.qos import QoSProfile, as_profile
from navette.runtime.qos_events import (
    PublisherEventCallbacks,
    SubscriptionEventCallbacks,
)
from navette.runtime.qos_overriding_options import QoSOverridingOptions, overridden
from navette.runtime.qos_watch import EndpointWatch
from navette.runtime.signatures import can_take
from navette.runtime.subscription import ContentFilterOptions, Subscription
from navette.runtime.type_support import interface_name
from navette.transports import Endpoint, EndpointKind

MsgT = TypeVar("MsgT")


class NodeTopics:
    """Factory of publishers and subscriptions; arguments as in :class:`Node`.

    Args:
        parameters: QoS overrides are declared as parameters of the node.
        logger: for warnings about incompatible endpoints.
    """

    def __init__(
        self, entities: NodeEntities, parameters: NodeParameters, logger: Logger
    ) -> None:
        self._entities = entities
        self._parameters = parameters
        self._logger = logger

    def create_publisher(
        self,
        msg_type: type[MsgT],
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        event_callbacks: PublisherEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        publisher_class: type[Publisher[Any]] = Publisher,
        other_types: Sequence[type | str] = (),
    ) -> Publisher[MsgT]:
        kind = EndpointKind.PUBLISHER
        qos = self._profile(kind, topic, qos_profile, qos_overriding_options)
        endpoint = self._endpoint(kind, msg_type, topic, qos, other_types)
        context = self._entities.context
        watch = EndpointWatch(context, endpoint, event_callbacks, self._logger)
        try:
            ports = [
                transport.advertise(endpoint, msg_type)
                for transport in context.graph.transports
            ]
        except NavetteError:
            watch.stop()
            raise
        publisher = publisher_class(
            msg_type,
            endpoint,
            qos,
            ports=ports,
            entities=self._entities,
            watch=watch,
        )
        self._entities.add(publisher)
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
        other_types: Sequence[type | str] = (),
        ignore_local_publications: bool = False,
    ) -> Subscription[MsgT]:
        if not can_take(callback, 1, 2):
            raise CallbackSignatureError(
                f"topic {topic}: callback {callback!r}: expected a function of the "
                "message, or of the message and its MessageInfo"
            )
        kind = EndpointKind.SUBSCRIPTION
        qos = self._profile(kind, topic, qos_profile, qos_overriding_options)
        endpoint = self._endpoint(kind, msg_type, topic, qos, other_types)
        if ignore_local_publications:
            endpoint = replace(endpoint, ignores_own_node=True)
        context = self._entities.context
        watch = EndpointWatch(context, endpoint, event_callbacks, self._logger)
        subscription: Subscription[MsgT] = Subscription(
            msg_type,
            endpoint,
            callback,
            callback_group=self._entities.adopt(callback_group),
            qos_profile=qos,
            entities=self._entities,
            watch=watch,
            raw=raw,
            shared=shared,
        )
        self._entities.add(subscription)
        sink = watch.observe(subscription.receive)
        try:
            if content_filter_options is not None:
                subscription.set_content_filter(*content_filter_options)
            for transport in context.graph.transports:
                port = transport.subscribe(
                    endpoint, msg_type, sink, shared=shared or raw
                )
                subscription.ports.append(port)
        except NavetteError:
            subscription.destroy()
            raise
        return subscription

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
        full_name = self._entities.remapper.resolve(topic)
        return overridden(self._parameters, kind.name.lower(), full_name, qos, options)

    def _endpoint(
        self,
        kind: EndpointKind,
        msg_type: type,
        topic: str,
        qos: QoSProfile,
        other_types: Sequence[type | str],
    ) -> Endpoint:
        type_name = interface_name(msg_type, "msg")
        others = tuple(
            other if isinstance(other, str) else interface_name(other, "msg")
            for other in other_types
        )
        endpoint = self._entities.new_endpoint(kind, type_name, topic, qos)
        return replace(endpoint, other_types=others) if others else endpoint
