"""Launch service: visits entities, passes events to handlers, shuts down in order."""

import asyncio
from collections.abc import Callable, Coroutine, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from threading import get_ident
from typing import Any

from navette.errors import CallbackError
from navette.ros2.packages.launch.asyncio_bridge import AsyncioBridge
from navette.ros2.packages.launch.errors import LaunchError
from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.events import Shutdown
from navette.ros2.packages.launch.launch_context import (
    ContextEntity,
    ContextHandler,
    LaunchContext,
    VisitEvent,
)
from navette.ros2.packages.launch.launch_description import LaunchDescription
from navette.ros2.packages.launch.launch_description_entity import (
    normalize_to_list_of_entities,
)
from navette.ros2.packages.launch.launched_process import LaunchedProcess
from navette.ros2.packages.launch.logging import console, get_logger
from navette.ros2.packages.launch.running import Runner
from navette.runtime.loop import EventLoop

SUCCEEDED = 0
FAILED = 1

_log = get_logger("launch")


class LaunchService:
    """Runs launch descriptions until everything that they started has ended.

    Args:
        argv: ``name:=value`` arguments.
        noninteractive: no user is at the terminal.
        debug: print debug messages.
        loop: runs events and timers (default: a loop on the system clock).
        runner: starts commands (default: a process for each).
    """

    def __init__(
        self,
        *,
        argv: Sequence[str] | None = None,
        noninteractive: bool = False,
        debug: bool = False,
        loop: EventLoop | None = None,
        runner: Runner | None = None,
    ) -> None:
        self.errors: list[LaunchError] = []
        self._shutting_down = False
        self._is_stalled = False
        self._shutdown_when_idle = True
        self.__context = LaunchContext(
            argv=argv,
            noninteractive=noninteractive,
            loop=loop,
            runner=runner,
        )
        self._bridge = AsyncioBridge(self.context, on_error=self._fail_of_future)
        self._async_run: _AsyncRun | None = None
        self._start_checks: list[Callable[[], None]] = []
        # A caller with its own runner prints the messages itself.
        self._console: Callable[[], AbstractContextManager[None]] = (
            partial(console, debug=debug) if runner is None else nullcontext
        )

    @property
    def context(self) -> LaunchContext:
        """What the actions of the launch read and change."""
        return self.__context

    @property
    def event_loop(self) -> EventLoop:
        """The loop that runs events and timers."""
        return self.context.loop

    def include_launch_description(self, description: LaunchDescription) -> None:
        """Visit a description when the service runs, from any thread."""
        self.context.visit_later([description])
        self.context.loop.call_soon_threadsafe(lambda: None, "launch")

    def emit_event(self, event: Event) -> None:
        """Queue an event from any thread."""
        self.context.emit_from_thread(event)

    def check_after_start(self, check: Callable[[], None]) -> None:
        """Call ``check`` once the descriptions have been visited; it may raise."""
        self._start_checks.append(check)

    def shutdown(
        self, force_sync: bool = False, reason: str = "requested"
    ) -> Coroutine[Any, Any, None] | None:
        """End everything from any thread; :meth:`run` returns then.

        Returns:
            A coroutine that waits for the end, in the thread of :meth:`run_async`.
        """
        self.emit_event(Shutdown(reason=reason))
        run = self._async_run
        if run is None or force_sync or run.thread != get_ident():
            return None
        return run.wait()

    def escalate(self) -> None:
        """Send the next, stronger signal to all processes, from any thread."""
        self.context.loop.call_soon_threadsafe(self._escalate, "escalate")

    def _escalate(self) -> None:
        for item in tuple(self.context.busy):
            if isinstance(item, LaunchedProcess):
                item.escalate()

    def run(self, *, shutdown_when_idle: bool = True) -> int:
        """Run to the end; return 0, or 1 if the launch failed.

        A failed launch ends what it has started. Processes that failed are in
        ``context.failed_labels``.
        """
        self._shutdown_when_idle = shutdown_when_idle
        self._shutting_down = self.context.is_shutdown = False
        self.errors.clear()
        with self._console():
            return self._run()

    async def run_async(self, *, shutdown_when_idle: bool = True) -> int:
        """Run to the end in a thread, as :meth:`run` does."""
        run = self._async_run = _AsyncRun()
        try:
            return await asyncio.to_thread(
                self.run, shutdown_when_idle=shutdown_when_idle
            )
        except asyncio.CancelledError:
            self.shutdown(reason="cancelled", force_sync=True)
            raise
        finally:
            run.over.set()
            self._async_run = None

    def _run(self) -> int:
        context = self.context
        context.save_environment()
        bridge = self._bridge = AsyncioBridge(context, on_error=self._fail_of_future)
        context.make_asyncio_loop = bridge.loop
        try:
            while not self._is_over():
                try:
                    self._handle_events()
                    context.loop.run(
                        done=lambda: context.has_events() or self._is_idle()
                    )
                    self._check_stall()
                except CallbackError as error:
                    self._fail(error)
        finally:
            context.make_asyncio_loop = None
            context._set_asyncio_loop(None)
            bridge.close()
            context.close()
            context.runner.close()
        return FAILED if self.errors else SUCCEEDED

    def _is_idle(self) -> bool:
        context = self.context
        if context.has_events() or context.busy:
            return False
        return self._shutting_down or self._shutdown_when_idle

    def _is_over(self) -> bool:
        """Return whether the launch is idle and handlers got a Shutdown event."""
        if self._is_stalled and self._shutting_down:
            return True
        if not self._is_idle():
            return False
        if self._shutting_down:
            return True
        self.context.emit_event_sync(
            Shutdown(reason="all processes and timers have ended")
        )
        return False

    def _check_stall(self) -> None:
        """Shut down if a virtual clock has no event left to advance to."""
        context = self.context
        has_no_event = context.loop.clock.is_virtual and not context.has_events()
        self._is_stalled = has_no_event and not self._is_idle()
        if self._is_stalled and not self._shutting_down:
            context.emit_event_sync(Shutdown(reason="no further event"))

    def _handle_events(self) -> None:
        context = self.context
        while context.has_events():
            event = context.next_event()
            try:
                self._handle(event)
                if not context.has_events():
                    checks, self._start_checks = self._start_checks, []
                    for check in checks:
                        _locate_errors("command line", "launch arguments", check)
            except LaunchError as error:
                self._fail(error)

    def _handle(self, event: Event) -> None:
        context = self.context
        if isinstance(event, VisitEvent):
            self._visit_all(event.entities, event.scope)
            return
        if isinstance(event, Shutdown) and not self._shutting_down:
            self._shutting_down = context.is_shutdown = True
            context.extend_globals({"event": event})
        for handler in context.event_handlers:
            # An earlier handler may have removed this one.
            if context.is_registered(handler) and handler.matches(event):
                self._call_handler(handler, event)

    def _call_handler(self, handler: ContextHandler, event: Event) -> None:
        context = self.context
        context._push_locals()
        try:
            where = getattr(handler, "origin", "") or "event handler"
            entities = _locate_errors(
                where, handler.describe(), lambda: handler.handle(event, context)
            )
            for entity in _locate_errors(
                where,
                handler.describe(),
                lambda: normalize_to_list_of_entities(entities),
            ):
                self._visit(entity)
        finally:
            context._pop_locals()

    def _visit_all(
        self, entities: Sequence[ContextEntity], scope: dict[str, Any]
    ) -> None:
        self.context._push_locals()
        self.context.extend_locals(scope)
        try:
            for entity in entities:
                self._visit(entity)
        finally:
            self.context._pop_locals()

    def _visit(self, entity: ContextEntity) -> None:
        found = _locate_errors(
            entity.origin or str(self.context.launch_file or "launch"),
            entity.describe(),
            lambda: entity.visit(self.context),
        )
        future = entity.get_asyncio_future()
        if future is not None and not future.done():
            self._bridge.wait_for(future)
        for each in found or []:
            self._visit(each)

    def _fail_of_future(self, error: BaseException) -> None:
        self._fail(LaunchError(f"coroutine of an action: {error!r}"))

    def _fail(self, error: LaunchError | CallbackError) -> None:
        cause = error.__cause__
        if isinstance(cause, LaunchError):
            error = cause
        if not isinstance(error, LaunchError):
            error = LaunchError(str(error))
        self.errors.append(error)
        _log.error("%s", error)
        self.context.clear_events()
        self.context.emit_event_sync(Shutdown(reason="the launch failed"))


class _AsyncRun:
    """A run whose caller waits in an asyncio loop."""

    def __init__(self) -> None:
        self.thread = get_ident()
        self.over = asyncio.Event()

    async def wait(self) -> None:
        await self.over.wait()


def _locate_errors(where: str, entity: str, work: Callable[[], Any]) -> Any:
    """Call ``work``; turn its exceptions into launch errors with a location.

    A launch file is a program and may raise any exception.
    """
    try:
        return work()
    except LaunchError:
        raise
    except Exception as error:  # a user's entity may raise anything
        raise LaunchError.at(where, entity, error) from error
