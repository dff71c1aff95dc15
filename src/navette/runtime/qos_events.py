"""QoS events: their data and their callbacks."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, ClassVar

from navette.errors import NavetteError
from navette.transports import QoSPolicyKind


class UnsupportedEventTypeError(NavetteError):
    """The transport does not support an event; never raised by Navette."""


@dataclass
class QoSCountInfo:
    """How often an event has occurred, in total and since the last callback."""

    total_count: int = 0
    total_count_change: int = 0


QoSRequestedDeadlineMissedInfo = QoSCountInfo
QoSOfferedDeadlineMissedInfo = QoSCountInfo
QoSLivelinessLostInfo = QoSCountInfo
QoSMessageLostInfo = QoSCountInfo
IncompatibleTypeInfo = QoSCountInfo


@dataclass
class QoSLivelinessChangedInfo:
    """Number of matched publishers that are alive and that are not."""

    alive_count: int = 0
    not_alive_count: int = 0
    alive_count_change: int = 0
    not_alive_count_change: int = 0


@dataclass
class QoSIncompatibleInfo:
    """Argument of ``incompatible_qos`` callbacks."""

    total_count: int
    total_count_change: int
    last_policy_kind: QoSPolicyKind


QoSRequestedIncompatibleQoSInfo = QoSIncompatibleInfo
QoSOfferedIncompatibleQoSInfo = QoSIncompatibleInfo


@dataclass
class QoSMatchedInfo:
    """Argument of ``matched`` callbacks."""

    total_count: int = 0
    total_count_change: int = 0
    current_count: int = 0
    current_count_change: int = 0


QoSSubscriptionMatchedInfo = QoSMatchedInfo
QoSPublisherMatchedInfo = QoSMatchedInfo

Callback = Callable[[Any], Any] | None


class QoSPublisherEventType(IntEnum):
    """Events of publishers; numbers as in rcl."""

    RCL_PUBLISHER_OFFERED_DEADLINE_MISSED = 0
    RCL_PUBLISHER_LIVELINESS_LOST = 1
    RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS = 2
    RCL_PUBLISHER_INCOMPATIBLE_TYPE = 3
    RCL_PUBLISHER_MATCHED = 4


class QoSSubscriptionEventType(IntEnum):
    """Events of subscriptions; numbers as in rcl."""

    RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED = 0
    RCL_SUBSCRIPTION_LIVELINESS_CHANGED = 1
    RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS = 2
    RCL_SUBSCRIPTION_MESSAGE_LOST = 3
    RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE = 4
    RCL_SUBSCRIPTION_MATCHED = 5


@dataclass(frozen=True)
class EventHandler:
    """An event type of an endpoint and its callback."""

    event_type: QoSPublisherEventType | QoSSubscriptionEventType
    callback: Callable[[Any], Any]


_PUBLISHER_EVENTS = dict(
    zip(
        ("deadline", "liveliness", "incompatible_qos", "incompatible_type", "matched"),
        QoSPublisherEventType,
        strict=True,
    )
)
_SUBSCRIPTION_EVENTS = dict(
    zip(
        (
            "deadline",
            "liveliness",
            "incompatible_qos",
            "message_lost",
            "incompatible_type",
            "matched",
        ),
        QoSSubscriptionEventType,
        strict=True,
    )
)


class EventCallbacks:
    """Callbacks for the QoS events of one endpoint.

    Without an ``incompatible_qos`` or ``incompatible_type`` callback a warning is
    logged instead, unless ``use_default_callbacks`` is false.

    Args:
        deadline: no sample within the deadline; gets a :class:`QoSCountInfo`.
        liveliness: see the subclasses.
        incompatible_qos: gets a :class:`QoSIncompatibleInfo`.
        incompatible_type: a remote endpoint uses another type on the topic; gets an
            :class:`IncompatibleTypeInfo`. In process, this is an exception instead.
        matched: gets a :class:`QoSMatchedInfo`.
    """

    def __init__(
        self,
        *,
        deadline: Callback = None,
        liveliness: Callback = None,
        incompatible_qos: Callback = None,
        incompatible_type: Callback = None,
        matched: Callback = None,
        use_default_callbacks: bool = True,
    ) -> None:
        self.deadline = deadline
        self.liveliness = liveliness
        self.incompatible_qos = incompatible_qos
        self.incompatible_type = incompatible_type
        self.matched = matched
        self.use_default_callbacks = use_default_callbacks

    _events: ClassVar[Mapping[str, QoSPublisherEventType | QoSSubscriptionEventType]]

    def handlers(self) -> list[EventHandler]:
        return [
            EventHandler(kind, getattr(self, name))
            for name, kind in self._events.items()
            if getattr(self, name) is not None
        ]


class PublisherEventCallbacks(EventCallbacks):
    """Events of a publisher; ``liveliness`` (:class:`QoSCountInfo`): lease expired."""

    _events = _PUBLISHER_EVENTS


class SubscriptionEventCallbacks(EventCallbacks):
    """Events of a subscription.

    Args:
        liveliness: gets a :class:`QoSLivelinessChangedInfo`.
        message_lost: samples of a remote publisher were lost; gets a
            :class:`QoSCountInfo`. In process no samples are lost.
    """

    _events = _SUBSCRIPTION_EVENTS

    def __init__(self, *, message_lost: Callback = None, **others: Any) -> None:
        super().__init__(**others)
        self.message_lost = message_lost
