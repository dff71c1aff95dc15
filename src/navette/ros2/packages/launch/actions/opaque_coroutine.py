"""Action that runs a coroutine of the launch file."""

import asyncio
from collections.abc import Callable, Coroutine, Iterable, Mapping
from typing import Any

from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.event_handlers import OnShutdown
from navette.ros2.packages.launch.launch_context import LaunchContext


class OpaqueCoroutine(Action):
    """Runs ``coroutine(context, *args, **kwargs)``; the launch waits for its end.

    Args:
        coroutine: the function; a shutdown of the launch cancels it.
        ignore_context: call it without the context.
    """

    def __init__(
        self,
        *,
        coroutine: Callable[..., Coroutine[Any, Any, Any]],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        ignore_context: bool = False,
        **left_over: Any,
    ) -> None:
        super().__init__(**left_over)
        if not asyncio.iscoroutinefunction(coroutine):
            raise InvalidLaunchValueError(
                f"OpaqueCoroutine: coroutine {coroutine!r}: expected an async function"
            )
        self._coroutine = coroutine
        self._args = tuple(args or ())
        self._kwargs = dict(kwargs or {})
        self._ignore_context = ignore_context
        self._task: asyncio.Task[Any] | None = None

    def execute(self, context: LaunchContext) -> None:
        loop = context.asyncio_loop
        assert loop is not None, "the launch runs"
        args = self._args if self._ignore_context else (context, *self._args)
        self._task = task = loop.create_task(self._coroutine(*args, **self._kwargs))

        def cancel(event: Event, context: LaunchContext) -> None:
            task.cancel()

        context.register_event_handler(OnShutdown(on_shutdown=cancel))

    def get_asyncio_future(self) -> "asyncio.Future[Any] | None":
        return self._task
