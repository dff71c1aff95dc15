"""Work that may have to wait for the network, done beside Zenoh's own threads."""

import threading
from collections import deque
from collections.abc import Callable

from navette.transports.leaving import wait_for_at_end

_MOST_THREADS = 8
_MOST_WAITING = 1000


class Errands:
    """Runs each errand in one of a few threads, which end with nothing to do."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._waiting: deque[Callable[[], None]] = deque()
        self._threads: set[threading.Thread] = set()
        self._is_open = True
        self._lock = threading.Lock()

    def do(self, errand: Callable[[], None]) -> bool:
        """Whether it will be done: not after the end, nor where too many wait."""
        with self._lock:
            if not self._is_open or len(self._waiting) >= _MOST_WAITING:
                return False
            self._waiting.append(errand)
            if len(self._threads) < _MOST_THREADS:
                thread = threading.Thread(
                    target=self._run, name=self._name, daemon=True
                )
                self._threads.add(thread)
                thread.start()
                wait_for_at_end(thread)
            return True

    def close(self, timeout_s: float) -> None:
        """Begin nothing more, and wait for what is under way."""
        with self._lock:
            self._is_open = False
            self._waiting.clear()
            threads = list(self._threads)
        for thread in threads:
            if thread is not threading.current_thread():
                thread.join(timeout_s)

    def _run(self) -> None:
        try:
            while (errand := self._next()) is not None:
                errand()
        finally:
            with self._lock:
                self._threads.discard(threading.current_thread())

    def _next(self) -> Callable[[], None] | None:
        with self._lock:
            if self._waiting:
                return self._waiting.popleft()
            # From here on another thread begins what comes.
            self._threads.discard(threading.current_thread())
            return None
