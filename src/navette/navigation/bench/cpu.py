"""CPU time of nodes, by their callbacks."""

import functools
import time
from collections import defaultdict
from collections.abc import Callable
from typing import Any

from navette.runtime import Node


class CpuMeter:
    """Sums the CPU time of the callbacks of nodes.

    The time of a callback includes what it calls in its thread; messages that it
    publishes are received later, in the time of the receiving node.
    """

    def __init__(self) -> None:
        self._seconds: defaultdict[str, float] = defaultdict(float)

    def watch(self, node: Node) -> None:
        """Measure the callbacks of the subscriptions and timers that the node has."""
        name = node.get_name()
        for subscription in node.subscriptions:
            subscription.callback = self._timed(name, subscription.callback)
        for timer in node.timers:
            if timer.callback is not None:
                timer.callback = self._timed(name, timer.callback)

    def seconds(self) -> dict[str, float]:
        """Return node → CPU seconds, the largest first."""
        return dict(sorted(self._seconds.items(), key=lambda item: -item[1]))

    def _timed(self, name: str, callback: Callable[..., Any]) -> Callable[..., Any]:
        sums = self._seconds

        @functools.wraps(callback)
        def call(*arguments: Any) -> Any:
            begin = time.thread_time()
            try:
                return callback(*arguments)
            finally:
                sums[name] += time.thread_time() - begin

        return call
