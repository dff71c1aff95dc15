"""Publishers."""

import logging
from collections.abc import Callable
from typing import Any, Generic, TypeVar, cast

from navette.errors import DecodeError, MessageError
from navette.msgs import deserialize, type_name
from navette.runtime.destroyable import Destroyable
from navette.runtime.exceptions import InvalidHandle
from navette.runtime.loop import EventLoop
from navette.runtime.qos import QoSProfile
from navette.runtime.qos_events import EventHandler
from navette.runtime.time import Duration
from navette.transports import Encoded, Endpoint, PublisherPort

MsgT = TypeVar("MsgT")

_log = logging.getLogger(__name__)


class Publisher(Destroyable, Generic[MsgT]):
    """Sends messages to a topic. Made by :meth:`Node.create_publisher`."""

    __slots__ = (
        "_loop",
        "_on_assertion",
        "_on_destroy",
        "_send",
        "_sequence",
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
        ports: list[PublisherPort],
        loop: EventLoop,
        on_destroy: Callable[["Publisher[Any]"], None],
    ) -> None:
        self.msg_type = msg_type
        self.endpoint = endpoint
        self.qos_profile = qos_profile
        self.ports = ports
        self._send = ports[0].send if len(ports) == 1 else self._send_to_all
        self._loop = loop
        self._sequence = max((port.initial_sequence for port in ports), default=0)
        self._on_assertion: Callable[[bool], None] | None = None
        #: What it calls back for.
        self.event_handlers: list[EventHandler] = []
        self._on_destroy = on_destroy

    def publish(self, msg: MsgT | bytes) -> None:
        """Send ``msg`` as it is now; later edits of the object are not seen.

        Raises:
            MessageError: not of the publisher's type (also a TypeError).
        """
        if msg.__class__ is not self.msg_type:
            msg = self._converted(msg)
        self._sequence = sequence = self._sequence + 1
        self._send(msg, self._loop.clock.now_ns, sequence)

    def publish_encoded(self, data: bytes) -> None:
        """Send a message that is there as CDR: decoded where it is read, or never.

        What turns out to be no such message is reported where it should be read.
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
        """How many subscriptions get the messages."""
        return sum(port.matched_count for port in self.ports)

    def watch(
        self,
        on_sample: Callable[[], None],
        on_assertion: Callable[[bool], None] | None,
    ) -> None:
        """Call back with every message, and with every assertion of liveliness.

        The latter are told whether all who listen hear of it.
        """
        send = self._send

        def watched(message: Any, source_ns: int, sequence: int) -> None:
            on_sample()
            send(message, source_ns, sequence)

        self._send = watched
        self._on_assertion = on_assertion

    def assert_liveliness(self) -> None:
        """Keep the lease of a publisher with manual liveliness."""
        if self._on_assertion is not None:
            told = [port.assert_alive() for port in self.ports]
            self._on_assertion(all(told))

    def wait_for_all_acked(self, timeout: Duration | None = None) -> bool:
        """In process a message is in the queues when ``publish`` returns."""
        return True

    def destroy(self) -> None:
        """Leave the topic."""
        for port in self.ports:
            port.close()
        self._send = self._send_nothing
        self._on_destroy(self)

    def _send_to_all(self, message: Any, source_ns: int, sequence: int) -> None:
        for port in self.ports:
            port.send(message, source_ns, sequence)

    def _send_nothing(self, message: Any, source_ns: int, sequence: int) -> None:
        raise InvalidHandle(
            f"publisher of {self.endpoint.topic} (node "
            f"{self.endpoint.node_full_name}) was destroyed"
        )

    def _report_undecodable(self, error: DecodeError) -> None:
        _log.warning("topic %s: not delivered: %s", self.endpoint.topic, error)

    def _converted(self, msg: Any) -> Any:
        if isinstance(msg, self.msg_type):
            return msg
        if isinstance(msg, bytes):
            return deserialize(msg, cast(Any, self.msg_type))
        raise MessageError(
            f"topic {self.endpoint.topic}: expected "
            f"{type_name(self.msg_type)}, got {type(msg).__name__}"
        )
