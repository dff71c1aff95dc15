"""What the publishers of a process have sent, for the reports of a lock-step."""

import threading
from collections import Counter
from collections.abc import Callable, Mapping

from navette.transports.lockstep.records import Sent


class SentTally:
    """Counts what goes out; from any thread."""

    def __init__(self) -> None:
        self._sent: dict[bytes, Sent] = {}
        self._changed: dict[bytes, Sent] = {}
        self._made: Counter[str] = Counter()
        self._lock = threading.Lock()

    def open(self, gid: bytes, node: str) -> Callable[[int], None]:
        """For one publisher: what to call with the number of each sample it sent."""
        with self._lock:
            self._made[node] += 1
            self._note(gid, Sent(node, self._made[node], 0, 0))

        def sent(sequence: int) -> None:
            with self._lock:
                now = self._sent[gid]
                self._note(gid, Sent(now.node, now.publisher, now.total + 1, sequence))

        return sent

    def changed(self) -> dict[bytes, Sent]:
        """What has not been granted yet."""
        with self._lock:
            return dict(self._changed)

    def granted(self, sent: Mapping[bytes, Sent]) -> None:
        """All know of this from now on."""
        with self._lock:
            for gid, each in sent.items():
                if self._changed.get(gid) == each:
                    del self._changed[gid]

    def _note(self, gid: bytes, sent: Sent) -> None:
        self._sent[gid] = self._changed[gid] = sent
