"""Follows the QoS events of one endpoint; incompatible QoS is warned about."""

import threading
from collections.abc import Callable
from typing import Any

from navette.runtime.context import Context
from navette.runtime.deadlines import Watchdog
from navette.runtime.liveliness import Lease, LivelinessView
from navette.runtime.log import Logger
from navette.runtime.qos_events import (
    EventCallbacks,
    IncompatibleTypeInfo,
    QoSCountInfo,
    QoSIncompatibleInfo,
    QoSMatchedInfo,
)
from navette.transports import INFINITE_NS, Endpoint, EndpointKind, Item, QoSPolicyKind

CallSoon = Callable[[Callable[[], Any], str], None]


class EndpointWatch:
    """Calls the callbacks of an endpoint until :meth:`stop`.

    An endpoint with neither a deadline nor a lease costs nothing per sample.
    """

    def __init__(
        self,
        context: Context,
        endpoint: Endpoint,
        callbacks: EventCallbacks | None,
        logger: Logger,
        call_soon: CallSoon,
    ) -> None:
        self._context = context
        self._endpoint = endpoint
        self._callbacks = callbacks or EventCallbacks()
        self._logger = logger
        self._call_soon = call_soon
        self._incompatible = 0
        self._other_types = 0
        self._lost = 0
        self._missed = 0
        self._match = QoSMatchedInfo()
        self._has_warned = False
        self._deadline: Watchdog | None = None
        self._lease: Lease | None = None
        self._view: LivelinessView | None = None
        #: Of publishers in other processes, by gid.
        self._leases: dict[bytes, Lease] = {}
        # Remote endpoints come and go in another thread than those here.
        self._counting = threading.Lock()
        graph = context.graph
        self._undo = [
            graph.on_incompatible(self._on_incompatible),
            graph.on_incompatible_type(self._on_incompatible_type),
            graph.on_lost(self._on_lost),
            graph.on_match(self._on_match),
        ]
        self._watch_deadline()
        self._watch_liveliness()

    def stop(self) -> None:
        """Follow no more."""
        for undo in self._undo:
            undo()
        if self._deadline is not None:
            self._deadline.stop()
        if self._lease is not None:
            self._lease.stop()
        for lease in list(self._leases.values()):
            lease.stop()

    @property
    def on_sample(self) -> Callable[[], None] | None:
        """What to call with every sample; None = nothing."""
        hooks = [
            *([self._deadline.restart] if self._deadline is not None else []),
            *([self._lease.renew] if self._lease is not None else []),
        ]
        if len(hooks) < 2:
            return hooks[0] if hooks else None

        def both() -> None:
            for hook in hooks:
                hook()

        return both

    @property
    def on_assertion(self) -> Callable[[bool], None] | None:
        """What to call when a publisher asserts that it is alive; heard by all?"""
        return None if self._lease is None else self._assert

    def watched(self, sink: Callable[[Item], None]) -> Callable[[Item], None]:
        """A subscription's sink, with its deadline looked after."""
        hook = self.on_sample
        if hook is None:
            return sink

        def receive(item: Item) -> None:
            hook()
            sink(item)

        return receive

    # -- inside ----------------------------------------------------------------

    def _watch_deadline(self) -> None:
        period_ns = self._endpoint.qos.deadline_ns
        if self._callbacks.deadline is not None and period_ns < INFINITE_NS:
            self._deadline = Watchdog(
                period_ns,
                self._on_deadline,
                self._context.loop,
                self._endpoint.node_full_name,
            )

    def _watch_liveliness(self) -> None:
        graph, loop = self._context.graph, self._context.loop
        if self._endpoint.kind is EndpointKind.SUBSCRIPTION:
            if self._callbacks.liveliness is not None:
                self._view = LivelinessView(graph, self._tell_liveliness)
                self._undo.append(graph.on_liveliness(self._on_liveliness))
                self._undo.append(graph.on_assertion(self._on_assertion))
        elif self._endpoint.qos.asserts_itself:
            self._lease = Lease(self._endpoint, graph, loop, self._tell_liveliness)

    def _tell(self, callback: Callable[[Any], Any] | None, info: Any, of: str) -> None:
        if callback is not None:
            self._call_soon(lambda: callback(info), f"{of} event")

    def _tell_liveliness(self, info: Any) -> None:
        self._tell(self._callbacks.liveliness, info, "liveliness")

    def _on_deadline(self) -> None:
        self._missed += 1
        self._tell(self._callbacks.deadline, QoSCountInfo(self._missed, 1), "deadline")

    def _on_incompatible(
        self,
        publisher: Endpoint,
        subscription: Endpoint,
        policies: tuple[QoSPolicyKind, ...],
    ) -> None:
        if self._endpoint not in (publisher, subscription):
            return
        self._incompatible += 1
        callback = self._callbacks.incompatible_qos
        if callback is not None:
            info = QoSIncompatibleInfo(self._incompatible, 1, policies[0])
            self._tell(callback, info, "incompatible_qos")
        elif self._callbacks.use_default_callbacks:
            self._logger.warning(self._warning(publisher, subscription, policies))

    def _on_incompatible_type(self, local: Endpoint, remote: Endpoint) -> None:
        if self._endpoint != local:
            return
        self._other_types += 1
        callback = self._callbacks.incompatible_type
        if callback is not None:
            info = IncompatibleTypeInfo(self._other_types, 1)
            self._tell(callback, info, "incompatible_type")
        elif self._callbacks.use_default_callbacks:
            self._logger.warning(_type_warning(local, remote))

    def _on_lost(self, subscription: Endpoint, count: int) -> None:
        if self._endpoint == subscription:
            self._lost += count
            callback = getattr(self._callbacks, "message_lost", None)
            self._tell(callback, QoSCountInfo(self._lost, count), "message_lost")

    def _on_match(self, publisher: Endpoint, subscription: Endpoint, up: bool) -> None:
        if self._endpoint not in (publisher, subscription):
            return
        if not up and publisher.gid in self._leases:
            self._leases.pop(publisher.gid).stop()
        with self._counting:
            if self._view is not None:
                self._view.on_match(publisher, up)
            step = 1 if up else -1
            if self._callbacks.matched is not None:
                total, current = self._match.total_count, self._match.current_count
                self._match = QoSMatchedInfo(total + up, int(up), current + step, step)
                self._tell(self._callbacks.matched, self._match, "matched")

    def _assert(self, is_heard: bool) -> None:
        assert self._lease is not None, "only a publisher with a lease asserts"
        self._lease.renew()
        if not is_heard and not self._has_warned:
            self._has_warned = True
            self._logger.warning(
                f"topic {self._endpoint.topic}: assert_liveliness() is heard by "
                "Navette's subscriptions only; those of ROS 2 take a publisher for "
                "alive by its messages: publish one within the lease"
            )

    def _on_liveliness(self, publisher: Endpoint, alive: bool) -> None:
        with self._counting:
            assert self._view is not None, "only a subscription with a view asks"
            self._view.on_liveliness(publisher, alive)

    def _on_assertion(self, publisher: Endpoint, subscription: Endpoint) -> None:
        if self._endpoint != subscription:
            return
        lease = self._leases.get(publisher.gid)
        if lease is None:
            lease = Lease(publisher, self._context.graph, self._context.loop)
            self._leases[publisher.gid] = lease
        lease.renew()

    def _warning(
        self,
        publisher: Endpoint,
        subscription: Endpoint,
        policies: tuple[QoSPolicyKind, ...],
    ) -> str:
        names = ", ".join(
            f"{kind.name} (offered {_shown(publisher, kind)}, "
            f"requested {_shown(subscription, kind)})"
            for kind in policies
        )
        if self._endpoint.kind is EndpointKind.PUBLISHER:
            other, effect = subscription, "no messages will be sent to it"
        else:
            other, effect = publisher, "no messages will be received from it"
        return (
            f"topic {self._endpoint.topic}: QoS incompatible with the "
            f"{other.kind.name.lower()} of {other.node_full_name}; {effect}. "
            f"Policies: {names}"
        )


def _type_warning(local: Endpoint, remote: Endpoint) -> str:
    if local.type_name == remote.type_name:
        other = f"another definition of {remote.type_name} ({remote.type_hash})"
    else:
        other = f"{remote.type_name}, not {local.type_name}"
    return (
        f"topic {local.topic}: the {remote.kind.name.lower()} of "
        f"{remote.node_full_name} has {other}; they will exchange no messages"
    )


def _shown(endpoint: Endpoint, kind: QoSPolicyKind) -> str:
    qos = endpoint.qos
    values: dict[QoSPolicyKind, Any] = {
        QoSPolicyKind.RELIABILITY: qos.reliability.name,
        QoSPolicyKind.DURABILITY: qos.durability.name,
        QoSPolicyKind.DEADLINE: f"{qos.deadline_ns / 1e9:g} s",
        QoSPolicyKind.LIVELINESS: qos.liveliness.name,
        QoSPolicyKind.LIVELINESS_LEASE_DURATION: f"{qos.lease_ns / 1e9:g} s",
    }
    return str(values[kind])
