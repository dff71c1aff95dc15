"""Publishers of topics."""

import logging
import math
from typing import Any, Generic, TypeVar

from navette.errors import DecodeError
from navette.runtime.destroyable import Destroyable
from navette.runtime.exceptions import InvalidHandle
from navette.runtime.node_entities import NodeEntities
from navette.runtime.qos import QoSProfile
from navette.runtime.qos_events import EventHandler
from navette.runtime.qos_watch import EndpointWatch
from navette.runtime.stamp_selection import StampSelection
from navette.runtime.time import Duration
from navette.runtime.type_support import check_type
from navette.transports import Encoded, Endpoint, PublisherPort

MsgT = TypeVar("MsgT")

_log = logging.getLogger(__name__)


class Publisher(Destroyable, Generic[MsgT]):
    """Sends messages to a topic. Created by :meth:`Node.create_publisher`."""

    __slots__ = (
        "_entities",
        "_hand_over",
        "_loop",
        "_selection",
        "_send",
        "_sequence",
        "_watch",
        "endpoint",
        "event_handlers",
        "msg_type",
        "ports",
        "qos_profile",
    )

    def __init__(
        self,
        msg_type: type[MsgT],
        endpoint: Endpoint,
        qos_profile: QoSProfile,
        *,
        ports: list[PublisherPort],
        entities: NodeEntities,
        watch: EndpointWatch,
    ) -> None:
        self.msg_type = msg_type
        self.endpoint = endpoint
        self.qos_profile = qos_profile
        self.ports = ports
        self._loop = entities.context.loop
        self._selection = StampSelection()
        self._sequence = max((port.initial_sequence for port in ports), default=0)
        self.event_handlers: list[EventHandler] = watch.event_handlers
        self._entities = entities
        self._watch = watch
        is_alone = len(ports) == 1
        self._send = watch.observe(ports[0].send if is_alone else self._send_to_all)
        self._hand_over = watch.observe(
            ports[0].hand_over if is_alone else self._hand_over_to_all
        )

    def publish(self, msg: MsgT | bytes) -> None:
        """Send a copy of ``msg``; later edits have no effect.

        Bytes are a serialised message, as in :meth:`publish_encoded`.

        Raises:
            MessageError: ``msg`` is of another type (also a TypeError).
            InvalidHandle: the publisher was destroyed.
        """
        if msg.__class__ is not self.msg_type:
            if isinstance(msg, bytes):
                self.publish_encoded(msg)
                return
            check_type(msg, self.msg_type, f"topic {self.endpoint.topic}")
        self._sequence = sequence = self._sequence + 1
        self._send(msg, self._loop.clock.now_ns, sequence)

    def hand_over(self, msg: MsgT) -> None:
        """Send a message that is not changed any more, without a copy where possible.

        Subscriptions that share messages get ``msg`` itself. Its float32 fields must
        hold values of 32 bits, which a copy would round.
        """
        self._sequence = sequence = self._sequence + 1
        self._hand_over(msg, self._loop.clock.now_ns, sequence)

    def publish_encoded(self, data: bytes) -> None:
        """Send a serialised message (CDR), which is decoded when a subscriber reads it.

        Data that cannot be decoded is logged then and not delivered.
        """
        self._sequence = sequence = self._sequence + 1
        message = Encoded(data, self.msg_type, self._report_undecodable)
        self._send(message, self._loop.clock.now_ns, sequence)

    @property
    def topic_name(self) -> str:
        return self.endpoint.topic

    @property
    def topic(self) -> str:
        return self.endpoint.topic

    def get_subscription_count(self) -> int:
        """Return the number of matched subscriptions."""
        count = 0
        for port in self.ports:
            count += port.matched_count
        return count

    def is_used(self, stamp_ns: int) -> bool:
        """Return whether to make the message with this stamp of a fast source.

        False if all subscriptions use the same number of messages per second (see
        :meth:`Subscription.limit_rate`), and this is none of them. To be called for
        each stamp.
        """
        rates = {port.most_hz for port in self.ports if port.matched_count}
        self._selection.rate_hz = rates.pop() if len(rates) == 1 else math.inf
        return self._selection.takes(stamp_ns)

    def assert_liveliness(self) -> None:
        """Renew the lease of a publisher with manual liveliness."""
        if self._watch.has_lease:
            reached = [port.assert_alive() for port in self.ports]
            self._watch.assert_liveliness(reaches_all=all(reached))

    def wait_for_all_acked(self, timeout: Duration | None = None) -> bool:
        """Return True: a message is in the queues when ``publish`` returns."""
        return True

    def destroy(self) -> None:
        """Leave the topic; a later :meth:`publish` raises InvalidHandle."""
        for port in self.ports:
            port.close()
        self._send = self._hand_over = self._refuse_to_send
        self._watch.stop()
        self._entities.forget(self)

    def _send_to_all(self, message: Any, source_ns: int, sequence: int) -> None:
        for port in self.ports:
            port.send(message, source_ns, sequence)

    def _hand_over_to_all(self, message: Any, source_ns: int, sequence: int) -> None:
        for port in self.ports:
            port.hand_over(message, source_ns, sequence)

    def _refuse_to_send(self, message: Any, source_ns: int, sequence: int) -> None:
        raise InvalidHandle(
            f"publisher of {self.endpoint.topic} (node "
            f"{self.endpoint.node_full_name}) was destroyed"
        )

    def _report_undecodable(self, error: DecodeError) -> None:
        _log.warning("topic %s: message not delivered: %s", self.endpoint.topic, error)
