"""Coroutines and futures of actions, run between the events of a launch."""

import asyncio
from collections.abc import Callable
from typing import Any

from navette.ros2.packages.launch.launch_context import LaunchContext

_PERIOD_S = 0.005


OnFailure = Callable[[BaseException], None]
"""Called with the exception of a future that failed."""


class AsyncioBridge:
    """An asyncio loop that runs in steps on the launch's loop, while something waits.

    Args:
        context: its ``busy`` holds the futures that the launch waits for.
    """

    def __init__(self, context: LaunchContext, *, on_error: OnFailure) -> None:
        self._context = context
        self._on_error = on_error
        self._loop: asyncio.AbstractEventLoop | None = None
        self._is_closed = False

    def loop(self) -> asyncio.AbstractEventLoop:
        """Return the asyncio loop; the first call makes it."""
        if self._loop is None:
            self._loop = asyncio.new_event_loop()
            self._schedule()
        return self._loop

    def wait_for(self, future: "asyncio.Future[Any]") -> None:
        """Keep the launch running until a future is done."""
        busy = self._context.busy
        busy.add(future)
        future.add_done_callback(self._done)

    def _done(self, future: "asyncio.Future[Any]") -> None:
        self._context.busy.discard(future)
        error = None if future.cancelled() else future.exception()
        if error is not None:
            self._on_error(error)

    def _schedule(self) -> None:
        self._context.call_after(_PERIOD_S, self._step, "coroutines of actions")

    def _step(self) -> None:
        if self._is_closed or self._loop is None:
            return
        self._loop.call_soon(self._loop.stop)
        self._loop.run_forever()
        has_tasks = bool(asyncio.all_tasks(self._loop))
        if has_tasks or not self._context.loop.clock.is_virtual:
            self._schedule()

    def close(self) -> None:
        """Cancel what still waits."""
        self._is_closed = True
        if self._loop is None:
            return
        for task in asyncio.all_tasks(self._loop):
            task.cancel()
        self._loop.call_soon(self._loop.stop)
        self._loop.run_forever()
        self._loop.close()
