"""Publishers: serialise once a message, and only while a remote subscription exists."""

import contextlib
import threading
from collections.abc import Callable
from functools import partial
from typing import Any

import zenoh

from navette.msgs import serialize
from navette.transports.base import PublisherPort
from navette.transports.encoded import Encoded
from navette.transports.lockstep import PublisherCount
from navette.transports.zenoh.attachment import Attachment
from navette.transports.zenoh.kept_sample import KeptSample, Sample
from navette.transports.zenoh.ports import PortOwner, ZenohEntity
from navette.transports.zenoh.retransmission import declare_publisher
from navette.transports.zenoh.shared_memory import MIN_BYTES


class ZenohPublisher(PublisherPort):
    """Publishes CDR with an attachment.

    A publisher that keeps samples (transient local or with retransmission) sends every
    sample, so that its cache is complete. It is declared with its first sample, because
    its cache costs every other session two declarations: each node has one such
    publisher for its log, and many nodes never log. If it keeps one sample only, it
    begins with the first remote subscription; until then :class:`KeptSample` holds the
    sample.

    Args:
        retransmits: whether subscriptions can fetch the samples that they missed.
        sent_count: in lock-step, counts the samples. No sample is dropped then.
    """

    def __init__(
        self,
        owner: PortOwner,
        entity: ZenohEntity,
        *,
        retransmits: bool,
        sent_count: PublisherCount | None = None,
    ) -> None:
        self.matches = entity.matches
        #: Newest sequence number, also of samples that had no remote subscription.
        self.last = entity.initial_sequence
        self._owner = owner
        self._entity = entity
        self._keeps_samples = entity.qos.is_latched or retransmits
        # More than one sample would be divided between two caches, without an order.
        self._is_lazy = (
            entity.qos.is_latched and retransmits and entity.qos.queue_length == 1
        )
        self._kept: KeptSample | None = None
        self._sent_count = sent_count
        self._is_open = True
        self._lock = threading.Lock()
        self._declare: Callable[[], Any] = partial(
            declare_publisher,
            owner.session.zenoh,
            entity.key,
            entity.qos,
            retransmits=retransmits,
            lossless=sent_count is not None,
        )
        self._publisher: Any = None
        self._put: Callable[..., None] = self._declare_and_put
        if not self._keeps_samples:
            self._publisher = self._declare()
            self._put = self._publisher.put

    def send(self, message: Any, source_ns: int, sequence: int) -> None:
        self.last = sequence
        if not (
            self.matches.remotes or self._keeps_samples or self._is_awaited(source_ns)
        ):
            return
        data: Any = message.data if message.__class__ is Encoded else serialize(message)
        if self._is_lazy and self._is_kept(data, source_ns, sequence):
            return
        if len(data) >= MIN_BYTES and not self._keeps_samples:
            # A cache would keep the shared memory.
            data = self._owner.session.shared_pools.stored(data)
        try:
            self._put(data, attachment=self._attachment(source_ns, sequence))
        except zenoh.ZError:
            if self._is_open and not self._owner.session.zenoh.is_closed():
                raise
            return  # closed meanwhile by another thread
        if self._sent_count is not None:
            self._sent_count.add(sequence)

    def hand_over(self, message: Any, source_ns: int, sequence: int) -> None:
        if not (self._is_lazy and self._is_kept(message, source_ns, sequence)):
            self.send(message, source_ns, sequence)

    def _attachment(self, source_ns: int, sequence: int) -> bytes:
        return Attachment(sequence, source_ns, self._entity.gid).encode()

    def _is_awaited(self, now_ns: int) -> bool:
        """Return whether a subscriber exists whose token is still unread (2 µs)."""
        is_recent = self._owner.session.last_received.is_recent(now_ns)
        if not is_recent or self._sent_count or self.matches.refused:
            return False
        publisher = self._publisher
        try:
            return publisher is not None and bool(publisher.matching_status.matching)
        except zenoh.ZError:  # the session was closed
            return False

    def _is_kept(self, message: Any, source_ns: int, sequence: int) -> bool:
        """Keep a message for late joiners, until a remote subscription exists.

        Args:
            message: is not changed any more; may be CDR.
        """
        self.last = sequence
        sample = Sample(message, self._attachment(source_ns, sequence))
        with self._lock:
            if not (self._is_lazy and self._is_open):
                return False
            with contextlib.suppress(zenoh.ZError):  # sending raises it, if at all
                if not self.matches.remotes and self._newest().replace(sample):
                    return True
            self._is_lazy = False
        return False

    def _newest(self) -> KeptSample:
        if self._kept is None:
            session = self._owner.session
            self._kept = KeptSample(session.zenoh, self._entity.key, session.log_once)
        return self._kept

    def assert_alive(self) -> bool:
        return self._owner.assert_liveliness(self.matches)

    @property
    def initial_sequence(self) -> int:
        return self._entity.initial_sequence

    @property
    def matched_count(self) -> int:
        return len(self.matches.remotes)

    def close(self) -> None:
        with self._lock:
            if not self._is_open:
                return
            self._is_open = self._keeps_samples = self._is_lazy = False
            publisher, self._publisher = self._publisher, None
            kept, self._kept = self._kept, None
            self._put = self._declare_and_put  # does nothing from here on
        self._owner.release(self)  # no remote matches from here on: nothing is sent
        for each in (publisher, kept):
            if each is not None:
                each.undeclare()

    def _declare_and_put(self, data: Any, *, attachment: bytes) -> None:
        with self._lock:
            if not self._is_open:
                return
            if self._publisher is None:
                self._publisher = self._declare()
            put, kept = self._publisher.put, self._kept
            if kept is None:
                self._put = put
        if kept is None:
            put(data, attachment=attachment)
        else:
            self._put_after(kept, partial(put, data, attachment=attachment))

    def _put_after(self, kept: KeptSample, put: Callable[[], None]) -> None:
        """Send a sample that follows the kept one, and end that one."""
        kept.end()
        if kept.defers(put):
            return
        put()
        with self._lock:
            is_first = self._kept is kept
            if is_first:
                self._kept = None
        if is_first:
            kept.undeclare()
