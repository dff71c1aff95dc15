"""Call of one function after several others have been called."""

from collections.abc import Callable
from threading import Lock
from typing import Any


class ReadyAggregator:
    """Calls ``ready_fn`` once :meth:`ready_fn` was called ``num_to_aggregate`` times.

    Args:
        ready_fn: the function; called at most once.
        num_to_aggregate: number of calls to wait for.
    """

    def __init__(self, ready_fn: Callable[[], Any], num_to_aggregate: int) -> None:
        self._ready_fn = ready_fn
        self._missing = num_to_aggregate
        self._lock = Lock()

    def ready_fn(self) -> None:
        with self._lock:
            self._missing -= 1
            is_last = self._missing == 0
        if is_last:
            self._ready_fn()
