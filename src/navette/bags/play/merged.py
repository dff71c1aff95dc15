"""Merge several recordings, and report damage instead of raising it."""

import heapq
from collections.abc import Collection, Iterator, Sequence
from operator import attrgetter

from navette.bags.bag import BagMessage, BagReader, BagTopic, Damage, OnDamage
from navette.bags.play.source import Source

_stamp = attrgetter("stamp_ns")


class TolerantSource:
    """A bag whose damaged parts are skipped, and reported once each."""

    def __init__(self, reader: BagReader, *, on_damage: OnDamage) -> None:
        self._reader = reader
        self._report = on_damage
        self._reported: set[Damage] = set()
        self.topics: Sequence[BagTopic] = reader.topics
        self.start_ns, self.end_ns = reader.start_ns, reader.end_ns

    def messages(
        self,
        topics: Collection[str] | None = None,
        *,
        start_ns: int | None = None,
        end_ns: int | None = None,
    ) -> Iterator[BagMessage]:
        return self._reader.messages(
            topics, start_ns=start_ns, end_ns=end_ns, on_damage=self._on_damage
        )

    def _on_damage(self, damage: Damage) -> None:
        if damage not in self._reported:  # once, also in loops
            self._reported.add(damage)
            self._report(damage)


class MergedSource:
    """The messages of several sources by stamp."""

    def __init__(self, sources: Sequence[Source]) -> None:
        self._sources = sources
        self.topics = tuple(dict.fromkeys(t for s in sources for t in s.topics))
        filled = [s for s in sources if s.topics]
        self.start_ns = min((s.start_ns for s in filled), default=0)
        self.end_ns = max((s.end_ns for s in filled), default=0)

    def messages(
        self,
        topics: Collection[str] | None = None,
        *,
        start_ns: int | None = None,
        end_ns: int | None = None,
    ) -> Iterator[BagMessage]:
        each = (
            s.messages(topics, start_ns=start_ns, end_ns=end_ns) for s in self._sources
        )
        return heapq.merge(*each, key=_stamp)
