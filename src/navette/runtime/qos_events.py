"""QoS events of endpoints: incompatible QoS is warned about unless told otherwise."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from navette.runtime.context import Context
from navette.runtime.log import Logger
from navette.transports import Endpoint, EndpointKind, QoSPolicyKind


@dataclass
class QoSIncompatibleInfo:
    """Handed to ``incompatible_qos`` callbacks."""

    total_count: int
    total_count_change: int
    last_policy_kind: QoSPolicyKind


QoSRequestedIncompatibleQoSInfo = QoSIncompatibleInfo
QoSOfferedIncompatibleQoSInfo = QoSIncompatibleInfo


@dataclass
class QoSMatchedInfo:
    """Handed to ``matched`` callbacks."""

    total_count: int = 0
    total_count_change: int = 0
    current_count: int = 0
    current_count_change: int = 0


QoSSubscriptionMatchedInfo = QoSMatchedInfo
QoSPublisherMatchedInfo = QoSMatchedInfo


class EventCallbacks:
    """What to call on events of one endpoint.

    Args:
        incompatible_qos: called with :class:`QoSIncompatibleInfo`; without it (and
            with ``use_default_callbacks``) a warning is logged.
        matched: called with :class:`QoSMatchedInfo`.
    """

    def __init__(
        self,
        *,
        incompatible_qos: Callable[[QoSIncompatibleInfo], None] | None = None,
        matched: Callable[[QoSMatchedInfo], None] | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        self.incompatible_qos = incompatible_qos
        self.matched = matched
        self.use_default_callbacks = use_default_callbacks


class PublisherEventCallbacks(EventCallbacks):
    """Events of a publisher."""


class SubscriptionEventCallbacks(EventCallbacks):
    """Events of a subscription."""


class _Watch:
    """Follows one endpoint's events."""

    def __init__(
        self,
        endpoint: Endpoint,
        callbacks: EventCallbacks,
        logger: Logger,
        call_soon: Callable[[Callable[[], Any], str], None],
    ) -> None:
        self._endpoint = endpoint
        self._callbacks = callbacks
        self._logger = logger
        self._call_soon = call_soon
        self._incompatible = 0
        self._match = QoSMatchedInfo()

    def on_incompatible(
        self,
        publisher: Endpoint,
        subscription: Endpoint,
        policies: tuple[QoSPolicyKind, ...],
    ) -> None:
        if self._endpoint not in (publisher, subscription):
            return
        self._incompatible += 1
        info = QoSIncompatibleInfo(self._incompatible, 1, policies[0])
        callback = self._callbacks.incompatible_qos
        if callback is not None:
            self._call_soon(lambda: callback(info), "incompatible_qos event")
        elif self._callbacks.use_default_callbacks:
            self._logger.warning(self._warning(publisher, subscription, policies))

    def on_match(self, publisher: Endpoint, subscription: Endpoint, up: bool) -> None:
        callback = self._callbacks.matched
        if callback is None or self._endpoint not in (publisher, subscription):
            return
        step = 1 if up else -1
        total, current = self._match.total_count, self._match.current_count
        info = QoSMatchedInfo(total + up, int(up), current + step, step)
        self._match = info
        self._call_soon(lambda: callback(info), "matched event")

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


def watch_endpoint(
    context: Context,
    endpoint: Endpoint,
    callbacks: EventCallbacks | None,
    logger: Logger,
    call_soon: Callable[[Callable[[], Any], str], None],
) -> Callable[[], None]:
    """Follow the endpoint's events until the returned function is called."""
    watch = _Watch(endpoint, callbacks or EventCallbacks(), logger, call_soon)
    undo_incompatible = context.graph.on_incompatible(watch.on_incompatible)
    undo_match = context.graph.on_match(watch.on_match)

    def undo() -> None:
        undo_incompatible()
        undo_match()

    return undo
