"""Subscriptions: check what arrives and queue its bytes; the executor decodes them."""

import threading
from functools import partial
from typing import Any

import zenoh

from navette.errors import DecodeError
from navette.transports.base import Endpoint, Item, Sink, SubscriptionPort
from navette.transports.encoded import Encoded
from navette.transports.expiring import Lifespans
from navette.transports.lockstep import BufferedSubscription
from navette.transports.zenoh.attachment import check_length, decode_attachment
from navette.transports.zenoh.ports import PortOwner, ZenohEntity
from navette.transports.zenoh.retransmission import declare_subscriber
from navette.transports.zenoh.sequence_filter import SequenceFilter
from navette.transports.zenoh.shared_memory import copied

_HEADER_SIZE = 4
_HEADERS = (b"\x00\x01", b"\x00\x00")  # plain CDR, little and big endian


class ZenohSubscription(SubscriptionPort):
    """Passes each sample to the sink as :class:`Encoded`, in the publisher's order.

    Args:
        retransmits: whether missed samples are fetched from the publisher.
        buffered: in lock-step, takes the samples instead of the sink, in any order.
    """

    #: A subscription sends nothing.
    last = 0

    def __init__(
        self,
        owner: PortOwner,
        entity: ZenohEntity,
        message_class: type,
        *,
        sink: Sink,
        retransmits: bool,
        buffered: BufferedSubscription | None = None,
    ) -> None:
        self.matches = entity.matches
        self._owner = owner
        self._message_class = message_class
        self._sink = sink
        self._buffered = buffered
        # Read for each sample.
        self._clock = owner.clock
        self._max_bytes = owner.session.settings.max_message_bytes
        self._last_received = owner.session.last_received
        self._lifespans = Lifespans(self.matches.by_gid, on_expired=self._log_expired)
        self._filter = SequenceFilter(self.matches.by_gid)
        self._lock = threading.Lock()
        # Samples may arrive before the declaration returns.
        self._is_open = True
        self._subscriber: Any = declare_subscriber(
            owner.session.zenoh,
            entity.key,
            # Not the announced QoS, in which BEST_AVAILABLE is volatile: a
            # subscription that accepts either durability fetches the history.
            entity.matches.endpoint.qos,
            self._on_sample,
            retransmits=retransmits,
        )

    @property
    def matched_count(self) -> int:
        return len(self.matches.remotes)

    def close(self) -> None:
        if not self._is_open:
            return
        self._is_open = False
        self._owner.release(self)
        self._subscriber.undeclare()
        if self._buffered is not None:
            self._buffered.close()

    # The following methods run on Zenoh's threads.

    def _on_sample(self, sample: zenoh.Sample) -> None:
        if not self._is_open:
            return
        try:
            gid, item = self._decoded(sample)
        except DecodeError as error:
            self._log_ignored(str(sample.source_info or ""), str(error))
            return
        matches = self.matches
        if gid not in matches.by_gid:
            if not self._is_for_here(gid):
                return
            item = self._lifespans.limited(gid, item)
        elif gid in matches.limited:
            item = self._lifespans.limited(gid, item)
        self._last_received.time_ns = item[2]
        if self._buffered is not None:
            self._buffered.take(gid, item)
            return
        if matches.asserting:
            matches.on_sample(gid, item)
        with self._lock:
            missing = self._filter.accept(gid, item[3])
            if missing is not None and self._is_open:
                self._sink(item)
        if missing:
            self._owner.session.graph.lost(matches.endpoint, missing)

    def _is_for_here(self, gid: bytes) -> bool:
        """Return whether samples of an unmatched publisher are for this port."""
        # A history query returns samples of this session's publishers too, whatever
        # its locality; the in-process transport has delivered them already.
        if gid in self._owner.own_gids or gid in self.matches.refused:
            return False
        if other := self.matches.publisher_of_other_topic(gid):
            self._log_ignored(other, f"sent on {other}; a link is being renewed")
            return False
        return True

    def _decoded(self, sample: zenoh.Sample) -> tuple[bytes, Item]:
        payload, attachment = sample.payload, sample.attachment
        check_length(payload, self._max_bytes)
        if attachment is None:
            raise DecodeError("without an attachment")
        sequence, source_ns, gid = decode_attachment(attachment.to_bytes())
        data = copied(payload)
        if data[:2] not in _HEADERS or len(data) < _HEADER_SIZE:
            raise DecodeError(_bad_header(data))
        message = Encoded(data, self._message_class, partial(self._log_damaged, gid))
        return gid, (message, source_ns, self._clock.now_ns, sequence)

    def _log_expired(self, publisher: Endpoint, text: str) -> None:
        topic = self.matches.endpoint.topic
        self._owner.session.log_once.warning(
            ("age", topic, publisher.gid.hex()), f"topic {topic}: {text}"
        )

    def _log_damaged(self, gid: bytes, error: DecodeError) -> None:
        self._log_ignored(gid.hex(), str(error))

    def _log_ignored(self, peer: str, reason: str) -> None:
        topic = self.matches.endpoint.topic
        self._owner.session.log_once.warning(
            ("sample", topic, peer), f"topic {topic}: message ignored: {reason}"
        )


def _bad_header(data: bytes) -> str:
    if len(data) < _HEADER_SIZE:
        return f"{len(data)} bytes: too short for a CDR header"
    return f"not plain CDR: header {data[:_HEADER_SIZE].hex(' ')}"
