"""Queue of messages from the executor's thread to the socket thread."""

import asyncio
import threading
from collections import deque
from collections.abc import Callable, Iterable

from navette.viewer.large_grid import Payload
from navette.viewer.session import Watch

_MAX_QUEUED = 64 * 2**20  # bytes
# Time between deliveries. Each wake-up of the loop's thread takes the interpreter from
# the executor's, which then waits for it, up to 5 ms.
_PERIOD_S = 0.02

Offer = tuple[Watch, int, Payload]
"""A message for the clients of a watch: watch, stamp in ns, payload."""

DeliverOffers = Callable[[Iterable[Offer]], None]
"""Receives queued messages, oldest first, on the loop's thread."""


class OfferQueue:
    """Accepts messages from any thread and delivers them on the loop's; never blocks.

    The loop is woken up for the first message only, then looks for more every
    ``_PERIOD_S`` until there are none. When more than ``_MAX_QUEUED`` bytes are queued,
    the oldest messages are dropped.
    """

    def __init__(
        self, loop: asyncio.AbstractEventLoop, *, deliver: DeliverOffers
    ) -> None:
        self._loop = loop
        self._deliver = deliver
        self._lock = threading.Lock()
        self._queued: deque[Offer] = deque()
        self._size = 0
        self._scheduled = False

    def add(self, watch: Watch, stamp_ns: int, payload: Payload) -> None:
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
            self._scheduled = bool(batch)
        if batch:
            self._loop.call_later(_PERIOD_S, self._run)
            self._deliver(batch)
