"""Compare two recordings message by message.

Messages of a topic are matched by their stamps. Both files are read once, by stamp, and
only unmatched messages are held in memory.
"""

import heapq
from collections import deque
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from typing import Any

from navette.bags.bag import BagMessage, BagTopic
from navette.bags.compare.fields import FieldDifference, message_differences
from navette.bags.compare.tolerance import Tolerances
from navette.bags.message_types import message_class
from navette.bags.play.source import Source
from navette.errors import DecodeError, InvalidValueError, NavetteError
from navette.msgs import deserialize, fields


@dataclass
class FieldSummary:
    """Differences of a field over all messages of a topic; the worst as example."""

    path: str
    messages: int = 0
    first_ns: int = 0
    worst: FieldDifference | None = None

    def add(self, stamp_ns: int, difference: FieldDifference) -> None:
        if not self.messages:
            self.first_ns = stamp_ns
        self.messages += 1
        if self.worst is None or difference.size > self.worst.size:
            self.worst = difference


@dataclass
class TopicComparison:
    name: str
    type_name: str
    compared: int = 0
    differing: int = 0
    missing: int = 0
    """Expected messages that are missing."""
    extra: int = 0
    """Messages that were not expected."""
    problem: str = ""
    """Reason if the topic could not be compared."""
    fields: dict[str, FieldSummary] = field(default_factory=dict)

    @property
    def same(self) -> bool:
        return not (self.differing or self.missing or self.extra or self.problem)

    @property
    def is_silent(self) -> bool:
        """Whether the other recording has no messages on the topic."""
        return not (self.compared or self.extra or self.problem)


@dataclass
class Comparison:
    topics: list[TopicComparison]
    unexpected: tuple[str, ...] = ()
    """Topics of the other recording only; not counted as a difference."""

    of_others: tuple[str, ...] = ()
    """Topics on which all messages may be those of other nodes; not compared."""

    @property
    def same(self) -> bool:
        return all(topic.same for topic in self.topics)


def compare(
    expected: Source,
    got: Source,
    *,
    topics: Collection[str] | None = None,
    tolerances: Tolerances | None = None,
    shared: Collection[str] = (),
    time_tolerance_ns: int = 0,
    start_ns: int | None = None,
    end_ns: int | None = None,
) -> Comparison:
    """Compare ``got`` with ``expected``.

    Args:
        topics: names to compare; all expected topics if None.
        shared: topics on which ``expected`` also has messages of nodes that ``got``
            does not have: a recording does not state who published a message.
        tolerances: allowed differences of numbers; none by default.
        time_tolerance_ns: allowed difference of the stamps of matched messages.
        start_ns, end_ns: range of stamps to compare; all if None.

    Raises:
        InvalidValueError: no topic to compare.
        FileFormatError: a recording is damaged.
    """
    wanted = {t.name: t for t in expected.topics if topics is None or t.name in topics}
    there = {t.name: t for t in got.topics if topics is None or t.name in topics}
    if not wanted and (topics is None or any(True for _ in got.messages(topics))):
        raise InvalidValueError(
            "nothing to compare: the expected recording has no messages on "
            f"{', '.join(sorted(there)) or 'any topic'}; was the node recorded?"
        )
    found = {
        name: _TopicPairs(topic, there.get(name), tolerances or Tolerances())
        for name, topic in wanted.items()
    }
    sides = (
        _side(number, source.messages(wanted, start_ns=start_ns, end_ns=end_ns))
        for number, source in enumerate((expected, got))
    )
    for stamp_ns, side, message in heapq.merge(*sides, key=lambda item: item[:2]):
        pairs = found[message.topic.name]
        pairs.expire(stamp_ns - time_tolerance_ns)
        pairs.take(side, message)
    for pairs in found.values():
        pairs.expire(None)
    unexpected = tuple(name for name in there if name not in wanted)
    of_others = tuple(n for n in found if n in shared and found[n].result.is_silent)
    compared = [found[name].result for name in found if name not in of_others]
    return Comparison(compared, unexpected, of_others)


def _side(
    side: int, messages: Iterator[BagMessage]
) -> Iterator[tuple[int, int, BagMessage]]:
    return ((message.stamp_ns, side, message) for message in messages)


def _nearest(waiting: deque[BagMessage]) -> BagMessage:
    """Take the first message of the newest stamp.

    With a time tolerance longer than the period, those before it wait for what is
    missing.
    """
    newest_ns = waiting[-1].stamp_ns
    at = next(k for k, each in enumerate(waiting) if each.stamp_ns == newest_ns)
    taken = waiting[at]
    del waiting[at]
    return taken


class _TopicPairs:
    """Matches the messages of a topic and compares them."""

    def __init__(
        self, topic: BagTopic, other: BagTopic | None, tolerances: Tolerances
    ) -> None:
        self.result = TopicComparison(topic.name, topic.type_name)
        self._tolerances = tolerances
        self._waiting: tuple[deque[BagMessage], deque[BagMessage]] = (deque(), deque())
        self._classes: tuple[Any, Any] | None = None
        if other is not None and other.type_name != topic.type_name:
            self.result.problem = f"type {topic.type_name} became {other.type_name}"
            return
        try:
            expected, got = message_class(topic), message_class(other or topic)
        except NavetteError as error:
            self.result.problem = str(error)
            return
        if fields(expected) != fields(got):
            self.result.problem = f"{topic.type_name} has different fields"
        else:
            self._classes = expected, got

    def take(self, side: int, message: BagMessage) -> None:
        partners = self._waiting[1 - side]
        if not partners:
            self._waiting[side].append(message)
            return
        partner = _nearest(partners)
        pair = (message, partner) if side == 0 else (partner, message)
        self._compare(*pair)

    def expire(self, before_ns: int | None) -> None:
        """Count messages older than a stamp (None: all) as unmatched."""
        for side, waiting in enumerate(self._waiting):
            while waiting and (before_ns is None or waiting[0].stamp_ns < before_ns):
                waiting.popleft()
                if side == 0:
                    self.result.missing += 1
                else:
                    self.result.extra += 1

    def _compare(self, expected: BagMessage, got: BagMessage) -> None:
        if self._classes is None:
            return
        result = self.result
        result.compared += 1
        if expected.data == got.data:
            return
        try:
            one = deserialize(expected.data, self._classes[0])
            other = deserialize(got.data, self._classes[1])
        except DecodeError as error:
            result.problem = f"at {expected.stamp_ns / 1e9:.3f} s: {error}"
            return
        differences = message_differences(
            one, other, lambda path: self._tolerances.of(result.name, path)
        )
        result.differing += bool(differences)
        for each in differences:
            summary = result.fields.setdefault(each.path, FieldSummary(each.path))
            summary.add(expected.stamp_ns, each)
