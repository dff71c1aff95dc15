"""Remote samples, buffered until a step begins and delivered in a repeatable order.

Samples arrive in an arbitrary order. They are buffered until all samples of the
previous step are there, and delivered in the order of (source stamp, topic, node,
publisher, sequence number), which is the same in every run.
"""

import threading
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import KW_ONLY, dataclass
from typing import Any, NamedTuple, Protocol

from navette.transports.base import Endpoint, Item, Sink
from navette.transports.lockstep.records import Sent

# Samples of publishers outside the lock-step that wait for the next step; the oldest
# are dropped first.
_MAX_OUTSIDE = 1000
_NONE = -1


class Missing(NamedTuple):
    """Samples that were sent and have not arrived."""

    topic: str
    node: str
    samples: int


class _FromPublisher:
    """What a subscription has received of one publisher of the lock-step."""

    def __init__(self) -> None:
        self.samples: dict[int, Item] = {}  # by sequence number
        self.total = 0  # samples that the publisher has reported
        self.needed = 0  # how many samples with numbers in (after, last] are due
        self.after = _NONE
        self.last = _NONE

    @property
    def missing(self) -> int:
        if not self.needed:
            return 0
        return self.needed - sum(self.after < n <= self.last for n in self.samples)

    def take_due(self) -> list[tuple[int, Item]]:
        """Remove the samples up to ``last``; return those after ``after``."""
        due = [(n, item) for n, item in self.samples.items() if n <= self.last]
        for number, _ in due:
            del self.samples[number]
        return [(number, item) for number, item in due if number > self.after]


class MatchedPublishers(Protocol):
    """The remote publishers of a subscription."""

    def publishers(self) -> Mapping[bytes, Endpoint]:
        """Return them by gid."""

    def on_sample(self, gid: bytes, item: Item) -> None:
        """Process that a sample is delivered."""


@dataclass(frozen=True)
class SubscriptionInfo:
    """What the buffer requires of a subscription.

    Attributes:
        matches: the publishers.
        sink: takes the samples when a step begins.
        is_latched: whether it receives samples sent before it existed.
        depth: how many of those at most; None: all.
    """

    topic: str
    matches: MatchedPublishers
    _: KW_ONLY
    sink: Sink
    is_latched: bool = False
    depth: int | None = None


class BufferedSubscription:
    """Samples of one subscription; :meth:`take` is called from any thread."""

    def __init__(
        self, buffer: "SampleBuffer", number: int, info: SubscriptionInfo
    ) -> None:
        self.info = info
        self._buffer = buffer
        self._number = number
        self._publishers: dict[bytes, _FromPublisher] = {}
        self._is_known = False  # whether it existed in the previous step
        #: (gid, item, whether it was there in the previous step)
        self._outside: deque[tuple[bytes, Item, bool]] = deque(maxlen=_MAX_OUTSIDE)

    def take(self, gid: bytes, item: Item) -> None:
        """Buffer a sample that has arrived; a duplicate is dropped."""
        with self._buffer.lock:
            received = self._publishers.get(gid)
            if received is None:
                self._outside.append((gid, item, False))
            elif item[3] > received.last or (
                received.needed and item[3] > received.after
            ):
                received.samples.setdefault(item[3], item)
        self._buffer.check_complete()

    def deliver(self, gid: bytes, item: Item, now_ns: int) -> None:
        """Pass a sample to the subscription, with ``now_ns`` as its received stamp."""
        message, source_ns, _, number = item
        item = message, source_ns, now_ns, number
        self.info.matches.on_sample(gid, item)
        self.info.sink(item)

    def close(self) -> None:
        self._buffer.remove(self)

    # The following methods are called under the buffer's lock.

    def expect(self, sent: Mapping[bytes, Sent], known: Mapping[bytes, Sent]) -> None:
        """Require the samples of the step that has ended.

        Args:
            sent: what publishers have sent in that step.
            known: what all publishers have ever sent; a new subscription requires
                those samples of it that the publishers keep.
        """
        remotes = self.info.matches.publishers()
        for gid, each in (sent if self._is_known else known).items():
            received = self._publishers.get(gid)
            if received is None and gid in remotes:
                received = self._publishers[gid] = _FromPublisher()
                self._begin(received, each, remotes[gid])
            elif received is not None:
                received.needed = each.total - received.total
                received.after = received.last
                received.total, received.last = each.total, each.last
        for gid in self._publishers.keys() - remotes.keys():
            if not self._publishers[gid].needed and not self._publishers[gid].samples:
                del self._publishers[gid]
        self._assign_outside()
        self._is_known = True

    def _begin(self, received: _FromPublisher, sent: Sent, publisher: Endpoint) -> None:
        received.total, received.last = sent.total, sent.last
        if self._is_known:  # the publisher is new
            received.needed, received.after = sent.total, _NONE
        elif self.info.is_latched and publisher.qos.is_latched:
            depths = (self.info.depth, publisher.qos.queue_length, sent.total)
            received.needed = min(depth for depth in depths if depth is not None)
            received.after = sent.last - received.needed
        else:
            received.needed, received.after = 0, sent.last

    def _assign_outside(self) -> None:
        """Assign samples that arrived before their publisher was known."""
        samples = list(self._outside)
        self._outside.clear()
        for gid, item, is_old in samples:
            received = self._publishers.get(gid)
            if received is None:
                self._outside.append((gid, item, is_old))
            elif item[3] > received.after:
                received.samples.setdefault(item[3], item)

    def missing(self, known: Mapping[bytes, Sent]) -> list[Missing]:
        return [
            Missing(self.info.topic, known[gid].node, received.missing)
            for gid, received in self._publishers.items()
            if received.missing > 0
        ]

    def is_complete(self) -> bool:
        return all(received.missing <= 0 for received in self._publishers.values())

    def take_due(self, known: Mapping[bytes, Sent]) -> list[tuple[Any, ...]]:
        """Return (order, gid, item, self) of the samples to deliver now."""
        found: list[tuple[Any, ...]] = []
        for gid, received in self._publishers.items():
            for number, item in received.take_due():
                sent = known[gid]
                order = (
                    item[1],
                    self.info.topic,
                    sent.node,
                    sent.publisher,
                    number,
                    self._number,
                )
                found.append((order, gid, item, self))
            received.needed = 0
            received.after = received.last
        return found

    def take_outside(self) -> list[tuple[bytes, Item]]:
        """Return samples from outside the lock-step that waited for a whole step."""
        found = [(gid, item) for gid, item, is_old in self._outside if is_old]
        waiting = [
            (gid, item, True) for gid, item, is_old in self._outside if not is_old
        ]
        self._outside.clear()
        self._outside.extend(waiting)
        return found


class SampleBuffer:
    """All samples that a process buffers between two steps."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        #: Called from any thread when all expected samples have arrived.
        self.on_complete: Callable[[], None] = lambda: None
        self._subscriptions: list[BufferedSubscription] = []
        self._known: dict[bytes, Sent] = {}
        self._count = 0
        self._is_waiting = False

    def open(self, info: SubscriptionInfo) -> BufferedSubscription:
        with self.lock:
            self._count += 1
            subscription = BufferedSubscription(self, self._count, info)
            self._subscriptions.append(subscription)
        return subscription

    def remove(self, subscription: BufferedSubscription) -> None:
        """Remove a subscription that closes; nothing is expected for it any more."""
        with self.lock:
            if subscription in self._subscriptions:
                self._subscriptions.remove(subscription)
        self.check_complete()

    def expect(self, sent: Mapping[bytes, Sent]) -> bool:
        """Require the samples of the ended step; return whether all have arrived."""
        with self.lock:
            self._known.update(sent)
            for subscription in self._subscriptions:
                subscription.expect(sent, self._known)
            complete = self._is_complete()
            self._is_waiting = not complete
            return complete

    def is_complete(self) -> bool:
        with self.lock:
            return self._is_complete()

    def missing(self) -> list[Missing]:
        with self.lock:
            return [m for s in self._subscriptions for m in s.missing(self._known)]

    def release(self, now_ns: int) -> int:
        """Deliver the samples that are due, in order; return how many."""
        with self.lock:
            due = [d for s in self._subscriptions for d in s.take_due(self._known)]
            outside = [(s, *o) for s in self._subscriptions for o in s.take_outside()]
        due.sort(key=lambda each: each[0])
        for _, gid, item, subscription in due:
            subscription.deliver(gid, item, now_ns)
        for subscription, gid, item in outside:
            subscription.deliver(gid, item, now_ns)
        return len(due) + len(outside)

    def check_complete(self) -> None:
        """Call ``on_complete`` if the last expected sample has arrived."""
        with self.lock:
            if not self._is_waiting or not self._is_complete():
                return
            self._is_waiting = False
        self.on_complete()

    def _is_complete(self) -> bool:
        return all(each.is_complete() for each in self._subscriptions)
