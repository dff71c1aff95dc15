"""Queue of messages from the executor's thread to the socket thread."""

import asyncio
import threading
from collections import deque
from collections.abc import Callable

from navette.viewer.session import Watch

_MAX_QUEUED = 64 * 2**20  # bytes


class OfferQueue:
    """Accepts messages from any thread and delivers them on the loop's; never blocks.

    At most one wake-up of the loop is scheduled; when more than ``_MAX_QUEUED`` bytes
    are queued, the oldest messages are dropped.
    """

    def __init__(
        self,
        loop: asyncio.AbstractEventLoop,
        deliver: Callable[[Watch, int, bytes], None],
        delivered: Callable[[], None],
    ) -> None:
        self._loop = loop
        self._deliver = deliver
        self._delivered = delivered
        self._lock = threading.Lock()
        self._queued: deque[tuple[Watch, int, bytes]] = deque()
        self._size = 0
        self._scheduled = False

    def add(self, watch: Watch, stamp_ns: int, payload: bytes) -> None:
        with self._lock:
            self._queued.append((watch, stamp_ns, payload))
            self._size += len(payload)
            while self._size > _MAX_QUEUED and len(self._queued) > 1:
                self._size -= len(self._queued.popleft()[2])
            if self._scheduled or self._loop.is_closed():
                return
            self._scheduled = True
        self._loop.call_soon_threadsafe(self._run)

    def _run(self) -> None:
        with self._lock:
            batch, self._queued = self._queued, deque()
            self._size = 0
            self._scheduled = False
        for offer in batch:
            self._deliver(*offer)
        self._delivered()
