"""Counts of the samples that a process has sent, for the reports of a lock-step."""

import threading
from collections import Counter
from collections.abc import Mapping

from navette.transports.lockstep.records import Sent


class SentCounter:
    """Counts samples of each publisher; used from any thread."""

    def __init__(self) -> None:
        self._sent: dict[bytes, Sent] = {}
        self._changed: dict[bytes, Sent] = {}
        self._publishers_of: Counter[str] = Counter()
        self._lock = threading.Lock()

    def open(self, gid: bytes, node: str) -> "PublisherCount":
        """Add a publisher; return its count."""
        with self._lock:
            self._publishers_of[node] += 1
            self._set(gid, Sent(node, self._publishers_of[node], 0, 0))
        return PublisherCount(self, gid)

    def add(self, gid: bytes, sequence: int) -> None:
        """Count one sample of a publisher."""
        with self._lock:
            old = self._sent[gid]
            self._set(gid, Sent(old.node, old.publisher, old.total + 1, sequence))

    def changed(self) -> dict[bytes, Sent]:
        """Return the counts that no grant has contained yet."""
        with self._lock:
            return dict(self._changed)

    def granted(self, sent: Mapping[bytes, Sent]) -> None:
        """Remove the counts that a grant has sent to all participants."""
        with self._lock:
            for gid, each in sent.items():
                if self._changed.get(gid) == each:
                    del self._changed[gid]

    def _set(self, gid: bytes, sent: Sent) -> None:
        self._sent[gid] = self._changed[gid] = sent


class PublisherCount:
    """Counts the samples of one publisher; used from any thread."""

    def __init__(self, counter: SentCounter, gid: bytes) -> None:
        self._counter, self._gid = counter, gid

    def add(self, sequence: int) -> None:
        """Count the sample with this sequence number."""
        self._counter.add(self._gid, sequence)
