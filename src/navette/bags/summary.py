"""Statistics of a recording."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from navette.bags.bag import BagReader, BagTopic
from navette.errors import NavetteError
from navette.msgs import get_interface, type_hash
from navette.msgs.definition_sections import read_definition
from navette.msgs.registration import differs

_BATCH = 65536


@dataclass(frozen=True)
class TopicSummary:
    topic: BagTopic
    count: int
    rate_hz: float | None
    """Median rate; None with fewer than two messages (or all at one time)."""
    mean_rate_hz: float | None
    """Mean rate between the first and the last message."""
    longest_gap_s: float | None
    """Longest time between two messages."""
    gap_start_s: float | None
    """Start of that gap, in seconds since the first message of the recording."""
    known: bool
    """Whether the type is installed, with the same fields."""

    def to_json(self) -> dict[str, Any]:
        return {
            "name": self.topic.name,
            "type": self.topic.type_name,
            "type_hash": self.topic.type_hash,
            "type_installed": self.known,
            "encoding": self.topic.encoding,
            "messages": self.count,
            "rate_hz": self.rate_hz,
            "mean_rate_hz": self.mean_rate_hz,
            "longest_gap_s": self.longest_gap_s,
            "longest_gap_start_s": self.gap_start_s,
            "qos": [vars(each) for each in self.topic.qos],
        }


@dataclass(frozen=True)
class BagSummary:
    """Statistics of a recording; stamps in nanoseconds, sizes in bytes."""

    path: Path
    storage: str
    version: str
    files: tuple[Path, ...]
    size: int
    start_ns: int
    end_ns: int
    messages: int
    compression: dict[str, int]
    topics: tuple[TopicSummary, ...]
    problems: tuple[str, ...]
    remarks: tuple[str, ...] = ()

    @property
    def duration_s(self) -> float:
        return (self.end_ns - self.start_ns) / 1e9

    def to_json(self) -> dict[str, Any]:
        return {
            "path": str(self.path),
            "storage": self.storage,
            "version": self.version,
            "files": [str(path) for path in self.files],
            "size": self.size,
            "duration_s": self.duration_s,
            "start_ns": self.start_ns,
            "end_ns": self.end_ns,
            "messages": self.messages,
            "compression": self.compression,
            "topics": [each.to_json() for each in self.topics],
            "problems": list(self.problems),
            "remarks": list(self.remarks),
        }


def summarise(
    reader: BagReader, on_stamps: Callable[[int], None] | None = None
) -> BagSummary:
    """Compute the statistics of an open recording from its stamps.

    Args:
        on_stamps: called with the number of stamps read since the last call.
    """
    stamps = _stamps_by_topic(reader, on_stamps)
    counts = reader.counts()
    topics = tuple(
        _summarise_topic(
            _joined(group),
            sum(counts[topic] for topic in group),
            [part for topic in group for part in stamps.get(topic, ())],
            reader.start_ns,
        )
        for _, group in sorted(_by_name_and_type(reader.topics).items())
    )
    return BagSummary(
        path=reader.path,
        storage=reader.storage,
        version=reader.version,
        files=reader.files,
        size=reader.size,
        start_ns=reader.start_ns,
        end_ns=reader.end_ns,
        messages=sum(counts.values()),
        compression=dict(reader.compression),
        topics=topics,
        problems=reader.problems,
        remarks=reader.remarks,
    )


def _by_name_and_type(
    topics: Sequence[BagTopic],
) -> dict[tuple[str, str, str], list[BagTopic]]:
    """Group the channels of several publishers of one topic."""
    groups: dict[tuple[str, str, str], list[BagTopic]] = {}
    for topic in topics:
        key = topic.name, topic.type_name, topic.encoding
        groups.setdefault(key, []).append(topic)
    return groups


def _joined(group: list[BagTopic]) -> BagTopic:
    """Return one topic with the QoS of all channels."""
    if len(group) == 1:
        return group[0]
    qos = dict.fromkeys(offer for topic in group for offer in topic.qos)
    return replace(group[0], qos=tuple(qos))


def _stamps_by_topic(
    reader: BagReader, on_stamps: Callable[[int], None] | None
) -> dict[BagTopic, list[np.ndarray[Any, np.dtype[np.int64]]]]:
    """Stamps in 8 bytes each: those of 100 million messages fit into memory."""
    pending: dict[BagTopic, list[int]] = {}
    found: dict[BagTopic, list[np.ndarray[Any, np.dtype[np.int64]]]] = {}
    number = 0
    for number, (topic, stamp) in enumerate(reader.stamps(), start=1):
        batch = pending.setdefault(topic, [])
        batch.append(stamp)
        if len(batch) == _BATCH:
            found.setdefault(topic, []).append(_array(batch))
            batch.clear()
        if on_stamps is not None and number % _BATCH == 0:
            on_stamps(_BATCH)
    for topic, batch in pending.items():
        found.setdefault(topic, []).append(_array(batch))
    return found


def _array(stamps: list[int]) -> np.ndarray[Any, np.dtype[np.int64]]:
    # A stamp beyond int64 is damaged; clipping keeps the others.
    return np.array([min(stamp, 2**63 - 1) for stamp in stamps], np.int64)


def _summarise_topic(
    topic: BagTopic,
    count: int,
    parts: list[np.ndarray[Any, np.dtype[np.int64]]] | None,
    start_ns: int,
) -> TopicSummary:
    rate = mean = gap = gap_start = None
    if parts and sum(map(len, parts)) > 1:
        stamps = np.sort(np.concatenate(parts))
        steps = np.diff(stamps)
        longest = int(np.argmax(steps))
        gap = float(steps[longest]) / 1e9
        gap_start = float(stamps[longest] - start_ns) / 1e9
        middle, span = float(np.median(steps)), int(stamps[-1]) - int(stamps[0])
        if span > 0:
            mean = len(steps) * 1e9 / span
        if middle > 0:
            rate = 1e9 / middle
    return TopicSummary(topic, count, rate, mean, gap, gap_start, is_installed(topic))


def is_installed(topic: BagTopic) -> bool:
    """Whether the installed type equals the recorded one."""
    return _is_installed(topic.type_name, topic.type_hash, topic.definition)


@lru_cache(maxsize=1024)  # topics of one type are many
def _is_installed(type_name: str, recorded_hash: str, definition: str) -> bool:
    try:
        get_interface(type_name)
        if recorded_hash.startswith("RIHS01_"):
            return recorded_hash == type_hash(type_name)
        if not definition:
            return True
        specs = read_definition(type_name, definition)
        return not any(differs(spec) for spec in specs)
    except NavetteError:
        return False
