"""QoS events of one endpoint: deadlines, liveliness, matches, incompatible peers."""

import threading
from collections import Counter
from collections.abc import Callable
from functools import partial
from typing import Any, ParamSpec

from navette.runtime.context import Context
from navette.runtime.deadlines import Watchdog
from navette.runtime.liveliness import Lease, LivelinessView
from navette.runtime.log import Logger
from navette.runtime.qos_events import (
    EventCallbacks,
    EventHandler,
    QoSCountInfo,
    QoSIncompatibleInfo,
    QoSMatchedInfo,
)
from navette.transports import (
    INFINITE_NS,
    Endpoint,
    EndpointKind,
    QoSPolicyKind,
)

P = ParamSpec("P")

_TYPE_WARNING_DELAY_NS = 1_000_000_000


class EndpointWatch:
    """Runs the event callbacks of an endpoint until :meth:`stop`.

    Without callbacks for incompatible endpoints a warning is logged. Samples of an
    endpoint without deadline and lease are not intercepted.
    """

    def __init__(
        self,
        context: Context,
        endpoint: Endpoint,
        callbacks: EventCallbacks | None,
        logger: Logger,
    ) -> None:
        self._context = context
        self._endpoint = endpoint
        self._callbacks = callbacks or EventCallbacks()
        self._logger = logger
        self.event_handlers: list[EventHandler] = (
            [] if callbacks is None else callbacks.handlers()
        )
        self._totals: Counter[str] = Counter()
        self._match = QoSMatchedInfo()
        self._has_warned = False
        self._deadline: Watchdog | None = None
        self._lease: Lease | None = None
        self._view: LivelinessView | None = None
        #: Leases of publishers in other processes, by gid.
        self._leases: dict[bytes, Lease] = {}
        # Remote endpoints match and unmatch in another thread than local ones.
        self._counting = threading.Lock()
        graph, topic = context.graph, endpoint.topic
        self._unsubscribe = [
            graph.on_incompatible(topic, self._on_incompatible),
            graph.on_incompatible_type(topic, self._on_incompatible_type),
            graph.on_lost(topic, self._on_lost),
            graph.on_match(topic, self._on_match),
        ]
        self._watch_deadline()
        self._watch_liveliness()

    def stop(self) -> None:
        for unsubscribe in self._unsubscribe:
            unsubscribe()
        if self._deadline is not None:
            self._deadline.stop()
        if self._lease is not None:
            self._lease.stop()
        for lease in list(self._leases.values()):
            lease.stop()

    @property
    def has_lease(self) -> bool:
        """Whether the endpoint is a publisher with manual liveliness."""
        return self._lease is not None

    def observe(self, deliver: Callable[P, None]) -> Callable[P, None]:
        """Extend ``deliver`` to restart the deadline and to renew the lease."""
        hooks: list[Callable[[], None]] = []
        if self._deadline is not None:
            hooks.append(self._deadline.restart)
        if self._lease is not None:
            hooks.append(self._lease.renew)
        if not hooks:
            return deliver

        def observed(*args: P.args, **kwargs: P.kwargs) -> None:
            for hook in hooks:
                hook()
            deliver(*args, **kwargs)

        return observed

    def assert_liveliness(self, *, reaches_all: bool) -> None:
        """Renew the publisher's lease.

        Args:
            reaches_all: whether every matched subscription receives the assertion;
                otherwise a warning is logged once.
        """
        assert self._lease is not None, "only a publisher with a lease asserts"
        self._lease.renew()
        if not reaches_all and not self._has_warned:
            self._has_warned = True
            self._logger.warning(
                f"topic {self._endpoint.topic}: assert_liveliness() reaches Navette's "
                "subscriptions only; ROS 2 subscriptions detect liveliness by "
                "messages: publish one within the lease"
            )

    def _watch_deadline(self) -> None:
        period_ns = self._endpoint.qos.deadline_ns
        if self._callbacks.deadline is not None and period_ns < INFINITE_NS:
            self._deadline = Watchdog(
                period_ns,
                self._context.loop,
                self._endpoint.node_full_name,
                on_expiry=self._on_deadline,
            )

    def _watch_liveliness(self) -> None:
        graph, loop = self._context.graph, self._context.loop
        if self._endpoint.kind is EndpointKind.SUBSCRIPTION:
            if self._callbacks.liveliness is not None:
                self._view = LivelinessView(graph, on_change=self._notify_liveliness)
                self._unsubscribe.append(graph.on_liveliness(self._on_liveliness))
                self._unsubscribe.append(
                    graph.on_assertion(self._endpoint.topic, self._on_assertion)
                )
        elif self._endpoint.qos.asserts_itself:
            self._lease = Lease(
                self._endpoint, graph, loop, on_lost=self._notify_liveliness
            )

    def _notify(
        self, callback: Callable[[Any], Any] | None, info: Any, event: str
    ) -> None:
        if callback is not None:
            self._context.loop.call_soon(
                lambda: callback(info), f"{event} event", self._endpoint.node_full_name
            )

    def _count(self, event: str, change: int = 1) -> QoSCountInfo:
        self._totals[event] += change
        return QoSCountInfo(self._totals[event], change)

    def _notify_liveliness(self, info: Any) -> None:
        self._notify(self._callbacks.liveliness, info, "liveliness")

    def _on_deadline(self) -> None:
        info = self._count("deadline")
        self._notify(self._callbacks.deadline, info, "deadline")

    def _on_incompatible(
        self,
        publisher: Endpoint,
        subscription: Endpoint,
        policies: tuple[QoSPolicyKind, ...],
    ) -> None:
        if self._endpoint not in (publisher, subscription):
            return
        total = self._count("incompatible_qos").total_count
        callback = self._callbacks.incompatible_qos
        if callback is not None:
            info = QoSIncompatibleInfo(total, 1, policies[0])
            self._notify(callback, info, "incompatible_qos")
        elif self._callbacks.use_default_callbacks:
            self._logger.warning(self._qos_warning(publisher, subscription, policies))

    def _on_incompatible_type(self, local: Endpoint, remote: Endpoint) -> None:
        if self._endpoint != local:
            return
        info = self._count("incompatible_type")
        callback = self._callbacks.incompatible_type
        if callback is not None:
            self._notify(callback, info, "incompatible_type")
        elif self._callbacks.use_default_callbacks:
            # Later: the remote node may handle several types, one after another.
            loop = self._context.loop
            check = partial(self._warn_of_type, local, remote)
            due_ns = loop.clock.now_ns + _TYPE_WARNING_DELAY_NS
            loop.call_at(due_ns, check, "type check", local.node_full_name)

    def _warn_of_type(self, local: Endpoint, remote: Endpoint) -> None:
        """Warn, unless the remote node has another endpoint, of this type."""
        found = self._context.graph.endpoints(
            remote.topic, kind=remote.kind, node=remote.node_full_name
        )
        refused = remote.type_name, remote.type_hash
        others = [e for e in found if (e.type_name, e.type_hash) != refused]
        if local.type_name not in {each.type_name for each in others}:
            self._logger.warning(_type_warning(local, remote))

    def _on_lost(self, subscription: Endpoint, count: int) -> None:
        if self._endpoint == subscription:
            callback = getattr(self._callbacks, "message_lost", None)
            info = self._count("message_lost", count)
            self._notify(callback, info, "message_lost")

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
                self._notify(self._callbacks.matched, self._match, "matched")

    def _on_liveliness(self, publisher: Endpoint, alive: bool) -> None:
        with self._counting:
            assert self._view is not None, "registered with the view only"
            self._view.on_liveliness(publisher, alive)

    def _on_assertion(self, publisher: Endpoint, subscription: Endpoint) -> None:
        if self._endpoint != subscription:
            return
        lease = self._leases.get(publisher.gid)
        if lease is None:
            lease = Lease(publisher, self._context.graph, self._context.loop)
            self._leases[publisher.gid] = lease
        lease.renew()

    def _qos_warning(
        self,
        publisher: Endpoint,
        subscription: Endpoint,
        policies: tuple[QoSPolicyKind, ...],
    ) -> str:
        names = ", ".join(
            f"{kind.name} (offered {_policy_text(publisher, kind)}, "
            f"requested {_policy_text(subscription, kind)})"
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
        other = f"a different definition of {remote.type_name} ({remote.type_hash})"
    else:
        other = f"{remote.type_name}, not {local.type_name}"
    return (
        f"topic {local.topic}: the {remote.kind.name.lower()} of "
        f"{remote.node_full_name} has {other}; the endpoints exchange no messages"
    )


def _policy_text(endpoint: Endpoint, kind: QoSPolicyKind) -> str:
    qos = endpoint.qos
    values: dict[QoSPolicyKind, Any] = {
        QoSPolicyKind.RELIABILITY: qos.reliability.name,
        QoSPolicyKind.DURABILITY: qos.durability.name,
        QoSPolicyKind.DEADLINE: f"{qos.deadline_ns / 1e9:g} s",
        QoSPolicyKind.LIVELINESS: qos.liveliness.name,
        QoSPolicyKind.LIVELINESS_LEASE_DURATION: f"{qos.lease_ns / 1e9:g} s",
    }
    return str(values[kind])
