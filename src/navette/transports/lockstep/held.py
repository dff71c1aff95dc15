"""Remote samples, held until a step begins and let go in an order of their own.

The order in which samples arrive is chance. Here they wait until all are there that
were sent in the step before, and then go in order of (time of sending, topic, node,
publisher, number), which is the same in every run.
"""

import threading
from collections import deque
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from navette.transports.base import Endpoint, Item, Sink
from navette.transports.lockstep.records import Sent

# Samples of publishers outside the lock-step that wait for the next step; the oldest
# go first.
_MOST_STRANGE = 1000
_NEVER = -1


class Missing(NamedTuple):
    """Samples that were sent and have not arrived."""

    topic: str
    node: str
    samples: int


class _Pair:
    """What a subscription has of one publisher of the lock-step."""

    __slots__ = ("after", "here", "need", "total", "upto")

    def __init__(self) -> None:
        self.here: dict[int, Item] = {}  # by number
        self.total = 0  # accounted for
        self.need = 0  # wanted of the numbers in (after, upto]
        self.after = _NEVER
        self.upto = _NEVER

    @property
    def missing(self) -> int:
        if not self.need:
            return 0
        return self.need - sum(self.after < n <= self.upto for n in self.here)

    def take(self) -> list[tuple[int, Item]]:
        """What is due, and no more of what came before."""
        due = [(n, item) for n, item in self.here.items() if n <= self.upto]
        for number, _ in due:
            del self.here[number]
        return [(number, item) for number, item in due if number > self.after]


class Holding:
    """The samples for one subscription; :meth:`take` comes from any thread.

    Args:
        is_latched: whether it gets what was sent before it was there.
        depth: at most so many of those; None = all.
        remotes: the publishers that it is matched with, by gid.
        heard: told whose samples are given to the subscription.
    """

    __slots__ = (
        "_held",
        "_is_known",
        "_pairs",
        "_strange",
        "depth",
        "heard",
        "is_latched",
        "number",
        "remotes",
        "sink",
        "topic",
    )

    def __init__(
        self,
        held: "HeldSamples",
        number: int,
        topic: str,
        sink: Sink,
        remotes: Callable[[], Mapping[bytes, Endpoint]],
        *,
        is_latched: bool,
        depth: int | None,
        heard: Callable[[bytes, Item], None],
    ) -> None:
        self._held = held
        self.heard = heard
        self.number = number
        self.topic = topic
        self.sink = sink
        self.remotes = remotes
        self.is_latched = is_latched
        self.depth = depth
        self._pairs: dict[bytes, _Pair] = {}
        self._is_known = False  # whether the others knew of it in the last step
        #: (gid, item, whether it was here in the last step already)
        self._strange: deque[tuple[bytes, Item, bool]] = deque(maxlen=_MOST_STRANGE)

    def take(self, gid: bytes, item: Item) -> None:
        """A sample that has arrived; one that was here before is dropped."""
        with self._held.lock:
            pair = self._pairs.get(gid)
            if pair is None:
                self._strange.append((gid, item, False))
            elif item[3] > pair.upto or (pair.need and item[3] > pair.after):
                pair.here.setdefault(item[3], item)
        self._held.arrived()

    def give(self, gid: bytes, item: Item, now_ns: int) -> None:
        """A sample to the subscription, received just now."""
        message, source_ns, _, number = item
        item = message, source_ns, now_ns, number
        self.heard(gid, item)
        self.sink(item)

    def close(self) -> None:
        """Forget what is held."""
        self._held.forget(self)

    # -- under the lock ----------------------------------------------------------

    def expect(self, sent: Mapping[bytes, Sent], known: Mapping[bytes, Sent]) -> None:
        """What was sent is due; of ``known``, to one that is new, what is kept."""
        remotes = self.remotes()
        for gid, each in (sent if self._is_known else known).items():
            pair = self._pairs.get(gid)
            if pair is None and gid in remotes:
                pair = self._pairs[gid] = _Pair()
                self._meet(pair, each, remotes[gid])
            elif pair is not None:
                pair.need, pair.after = each.total - pair.total, pair.upto
                pair.total, pair.upto = each.total, each.last
        for gid in self._pairs.keys() - remotes.keys():
            if not self._pairs[gid].need and not self._pairs[gid].here:
                del self._pairs[gid]
        self._sort_strangers()
        self._is_known = True

    def _meet(self, pair: _Pair, sent: Sent, publisher: Endpoint) -> None:
        pair.total, pair.upto = sent.total, sent.last
        if self._is_known:  # the publisher is the new one
            pair.need, pair.after = sent.total, _NEVER
        elif self.is_latched and publisher.qos.is_latched:
            depths = (self.depth, publisher.qos.queue_length, sent.total)
            pair.need = min(depth for depth in depths if depth is not None)
            pair.after = sent.last - pair.need
        else:
            pair.need, pair.after = 0, sent.last

    def _sort_strangers(self) -> None:
        """Samples that came before their publisher was known are no strangers'."""
        strangers = list(self._strange)
        self._strange.clear()
        for gid, item, is_old in strangers:
            pair = self._pairs.get(gid)
            if pair is None:
                self._strange.append((gid, item, is_old))
            elif item[3] > pair.after:
                pair.here.setdefault(item[3], item)

    def missing(self, known: Mapping[bytes, Sent]) -> list[Missing]:
        return [
            Missing(self.topic, known[gid].node, pair.missing)
            for gid, pair in self._pairs.items()
            if pair.missing > 0
        ]

    def is_complete(self) -> bool:
        return all(pair.missing <= 0 for pair in self._pairs.values())

    def due(self, known: Mapping[bytes, Sent]) -> list[tuple[Any, ...]]:
        """(order, gid, item, for whom) of what goes now."""
        found: list[tuple[Any, ...]] = []
        for gid, pair in self._pairs.items():
            for number, item in pair.take():
                sent = known[gid]
                order = (
                    item[1],
                    self.topic,
                    sent.node,
                    sent.publisher,
                    number,
                    self.number,
                )
                found.append((order, gid, item, self))
            pair.need = 0
            pair.after = pair.upto
        return found

    def strangers(self) -> list[tuple[bytes, Item]]:
        """Samples of publishers outside, that have been here for a whole step."""
        found = [(gid, item) for gid, item, is_old in self._strange if is_old]
        waiting = [
            (gid, item, True) for gid, item, is_old in self._strange if not is_old
        ]
        self._strange.clear()
        self._strange.extend(waiting)
        return found


class HeldSamples:
    """All that is held in a process, between two steps of time."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        #: Called when all has arrived that was expected; from any thread.
        self.on_complete: Callable[[], None] = _nothing
        self._holdings: list[Holding] = []
        self._known: dict[bytes, Sent] = {}
        self._count = 0
        self._is_waiting = False

    def open(
        self,
        topic: str,
        sink: Sink,
        remotes: Callable[[], Mapping[bytes, Endpoint]],
        *,
        is_latched: bool,
        depth: int | None,
        heard: Callable[[bytes, Item], None] | None = None,
    ) -> Holding:
        """For one subscription."""
        with self.lock:
            self._count += 1
            holding = Holding(
                self,
                self._count,
                topic,
                sink,
                remotes,
                is_latched=is_latched,
                depth=depth,
                heard=heard or _unheeded,
            )
            self._holdings.append(holding)
        return holding

    def forget(self, holding: Holding) -> None:
        """The subscription is gone."""
        with self.lock:
            if holding in self._holdings:
                self._holdings.remove(holding)
        self.arrived()

    def expect(self, sent: Mapping[bytes, Sent]) -> bool:
        """A step ended in which this was sent; whether all of it is here."""
        with self.lock:
            self._known.update(sent)
            for holding in self._holdings:
                holding.expect(sent, self._known)
            complete = self._is_complete()
            self._is_waiting = not complete
            return complete

    def is_complete(self) -> bool:
        """Whether all that was expected is here."""
        with self.lock:
            return self._is_complete()

    def missing(self) -> list[Missing]:
        """What was expected and is not here."""
        with self.lock:
            return [m for h in self._holdings for m in h.missing(self._known)]

    def release(self, now_ns: int) -> int:
        """Give what is due to the subscriptions, in order; how many samples."""
        with self.lock:
            due = [each for h in self._holdings for each in h.due(self._known)]
            strange = [(h, *each) for h in self._holdings for each in h.strangers()]
        due.sort(key=lambda each: each[0])
        for _, gid, item, holding in due:
            holding.give(gid, item, now_ns)
        for holding, gid, item in strange:
            holding.give(gid, item, now_ns)
        return len(due) + len(strange)

    def arrived(self) -> None:
        """Something has come: it may be what was waited for."""
        with self.lock:
            if not self._is_waiting or not self._is_complete():
                return
            self._is_waiting = False
        self.on_complete()

    def _is_complete(self) -> bool:
        return all(holding.is_complete() for holding in self._holdings)


def _nothing() -> None:
    """Nobody waits."""


def _unheeded(gid: bytes, item: Item) -> None:
    """Nobody asked."""
