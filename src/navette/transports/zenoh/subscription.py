"""Subscriptions: check what arrives and queue its bytes; who takes it decodes."""

from collections.abc import Callable
from collections.abc import Set as AbstractSet
from typing import Any

import zenoh
from zenoh import ext

from navette.errors import DecodeError
from navette.transports.base import Endpoint, Item, Sink, SubscriptionPort
from navette.transports.encoded import Encoded
from navette.transports.expiring import Lifespans
from navette.transports.lockstep import Holding
from navette.transports.qos import EndpointQos
from navette.transports.zenoh.attachment import decode_attachment
from navette.transports.zenoh.complaints import Complaints
from navette.transports.zenoh.heard import Heard
from navette.transports.zenoh.matches import Matches
from navette.transports.zenoh.recovery import Arrivals, Recovered, Wants

_HEADER_SIZE = 4
_HEADERS = (b"\x00\x01", b"\x00\x00")  # plain CDR, little and big endian


class ZenohSubscription(SubscriptionPort):
    """Gives each sample to the sink as :class:`Encoded`, in the publisher's order.

    Args:
        wants: where to ask for what is missing; None: nowhere.
        own_gids: publishers of this very session. Their samples come by another way; a
            query of the history brings them all the same, whatever its locality.
        heard: notes that something came.
        lost: told how many samples were missing and will not come.
        now_ns: the time here, for the received stamp.
        closed: called once when the port is closed.
        holding: in lock-step, where samples go instead of the sink; in any order.
    """

    #: It numbers nothing.
    last = 0

    __slots__ = (
        "_arrivals",
        "_closed",
        "_complaints",
        "_heard",
        "_holding",
        "_is_open",
        "_lifespans",
        "_longest",
        "_message_class",
        "_now_ns",
        "_own_gids",
        "_subscriber",
        "matches",
    )

    def __init__(
        self,
        session: zenoh.Session,
        key: str,
        message_class: type,
        sink: Sink,
        matches: Matches,
        *,
        wants: Wants | None,
        own_gids: AbstractSet[bytes],
        lost: Callable[[int], None],
        complaints: Complaints,
        heard: Heard,
        max_message_bytes: int,
        now_ns: Callable[[], int],
        closed: Callable[["ZenohSubscription"], None],
        holding: Holding | None = None,
    ) -> None:
        self.matches = matches
        self._message_class = message_class
        self._own_gids = own_gids
        self._complaints = complaints
        self._heard = heard
        self._longest = max_message_bytes
        self._now_ns = now_ns
        self._closed = closed
        self._holding = holding
        self._lifespans = Lifespans(matches.by_gid, self._complain_of_age)
        self._arrivals = Arrivals(
            matches, key, sink, lost=lost, checked=self._checked, wants=wants
        )
        # Samples may come before the declaration returns.
        self._is_open = True
        self._subscriber: Any = _declare(
            session, key, matches.endpoint.qos, self._on_sample
        )

    @property
    def arrivals(self) -> Arrivals:
        """Who puts the samples in order."""
        return self._arrivals

    @property
    def matched_count(self) -> int:
        return len(self.matches.remotes)

    def close(self) -> None:
        if not self._is_open:
            return
        self._is_open = False
        self._closed(self)
        self._subscriber.undeclare()
        self._arrivals.close()
        if self._holding is not None:
            self._holding.close()

    # -- on Zenoh's threads ------------------------------------------------------

    def _on_sample(self, sample: zenoh.Sample) -> None:
        found = self._checked(sample)
        if found is None:
            return
        self._heard.last_ns = found[1][2]
        if self._holding is None:
            if self.matches.asserting:
                self.matches.heard(*found)
            self._arrivals.take(*found)
        else:
            self._holding.take(*found)

    def _checked(self, sample: zenoh.Sample | Recovered) -> tuple[bytes, Item] | None:
        """Whose it is, and the item to deliver; None where it is none."""
        if not self._is_open:
            return None
        try:
            gid, item = self._decoded(sample)
        except DecodeError as error:
            self._complain(str(sample.source_info or ""), error)
            return None
        if gid in self._own_gids or gid in self.matches.refused:
            return None
        if other := self.matches.astray_from(gid):
            renewed = f"sent on {other}; a link is being renewed"
            self._complain(other, DecodeError(renewed))
            return None
        return gid, self._lifespans.limited(gid, item)

    def _decoded(self, sample: zenoh.Sample | Recovered) -> tuple[bytes, Item]:
        payload, attachment = sample.payload, sample.attachment
        if len(payload) > self._longest:
            raise DecodeError(
                f"{len(payload)} bytes: longer than {self._longest} "
                "(NAVETTE_MAX_MESSAGE_BYTES)"
            )
        if attachment is None:
            raise DecodeError("without an attachment")
        if len(payload) < _HEADER_SIZE:
            raise DecodeError(f"{len(payload)} bytes: no CDR header")
        sequence, source_ns, gid = decode_attachment(attachment.to_bytes())
        data = payload.to_bytes()
        if data[:2] not in _HEADERS:
            raise DecodeError(f"no plain CDR: header {data[:4].hex(' ')}")

        def failed(error: DecodeError) -> None:
            self._complain(gid.hex(), error)

        message = Encoded(data, self._message_class, failed)
        return gid, (message, source_ns, self._now_ns(), sequence)

    def _complain_of_age(self, publisher: Endpoint, text: str) -> None:
        topic = self.matches.endpoint.topic
        self._complaints.once(
            ("age", topic, publisher.gid.hex()), f"topic {topic}: {text}"
        )

    def _complain(self, peer: str, error: DecodeError) -> None:
        topic = self.matches.endpoint.topic
        self._complaints.once(
            ("sample", topic, peer), f"topic {topic}: message ignored: {error}"
        )


def _declare(
    session: zenoh.Session,
    key: str,
    qos: EndpointQos,
    on_sample: Callable[[zenoh.Sample], None],
) -> Any:
    # Direct: a thread of Python's for every subscription would be many.
    handler = zenoh.handlers.Callback(on_sample, indirect=False)
    if not qos.is_latched:
        return session.declare_subscriber(
            key, handler, allowed_origin=zenoh.Locality.REMOTE
        )
    return ext.declare_advanced_subscriber(
        session,
        key,
        handler,
        allowed_origin=zenoh.Locality.REMOTE,
        history=ext.HistoryConfig(
            detect_late_publishers=True, max_samples=qos.queue_length
        ),
    )
