"""Launch service: visits entities, passes events to handlers, shuts down in order."""

from collections.abc import Callable, Sequence
from contextlib import nullcontext
from typing import Any

from navette.errors import CallbackError
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
        self.context = LaunchContext(
            argv=argv,
            noninteractive=noninteractive,
            loop=loop,
            runner=runner,
        )
        self._start_checks: list[Callable[[], None]] = []
        # A caller with its own runner prints the messages itself.
        self._console = console(debug=debug) if runner is None else nullcontext()

    @property
    def event_loop(self) -> EventLoop:
        """The loop that runs events and timers."""
        return self.context.loop

    def include_launch_description(self, description: LaunchDescription) -> None:
        """Visit a description when the service runs."""
        self.context.visit_later([description])

    def emit_event(self, event: Event) -> None:
        """Queue an event from any thread."""
        self.context.emit_from_thread(event)

    def check_after_start(self, check: Callable[[], None]) -> None:
        """Call ``check`` once the descriptions have been visited; it may raise."""
        self._start_checks.append(check)

    def shutdown(self, force_sync: bool = False, reason: str = "requested") -> None:
        """End everything from any thread; :meth:`run` returns then."""
        self.emit_event(Shutdown(reason=reason))

    def escalate(self) -> None:
        """Send the next, stronger signal to all processes, from any thread."""
        self.context.loop.call_soon_threadsafe(self._escalate, "escalate")

    def _escalate(self) -> None:
        for item in tuple(self.context.busy):
            if isinstance(item, LaunchedProcess):
                item.escalate()

    def run(self, *, shutdown_when_idle: bool = True) -> int:
        """Run to the end; return 0, or 1 if the launch or a process failed.

        A failed launch ends what it has started.
        """
        self._shutdown_when_idle = shutdown_when_idle
        with self._console:
            return self._run()

    def _run(self) -> int:
        context = self.context
        context.save_environment()
        try:
            while not self._is_over():
                try:
                    self._handle_events()
                    context.loop.run(
                        done=lambda: bool(context.events) or self._is_idle()
                    )
                    self._check_stall()
                except CallbackError as error:
                    self._fail(error)
        finally:
            context.close()
            context.runner.close()
        return FAILED if self.errors or context.failed_labels else SUCCEEDED

    def _is_idle(self) -> bool:
        context = self.context
        if context.events or context.busy:
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
        self.context.emit_event(Shutdown(reason="all processes and timers have ended"))
        return False

    def _check_stall(self) -> None:
        """Shut down if a virtual clock has no event left to advance to."""
        context = self.context
        has_no_event = context.loop.clock.is_virtual and not context.events
        self._is_stalled = has_no_event and not self._is_idle()
        if self._is_stalled and not self._shutting_down:
            context.emit_event(Shutdown(reason="no further event"))

    def _handle_events(self) -> None:
        context = self.context
        while context.events:
            event = context.events.popleft()
            try:
                self._handle(event)
                if not context.events:
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
        if isinstance(event, Shutdown):
            if self._shutting_down:
                return
            self._shutting_down = context.is_shutdown = True
            context.extend_globals({"event": event})
        for handler in context.event_handlers:
            # An earlier handler may have removed this one.
            if context.is_registered(handler) and handler.matches(event):
                self._call_handler(handler, event)

    def _call_handler(self, handler: ContextHandler, event: Event) -> None:
        context = self.context
        context.push_locals()
        try:
            where = getattr(handler, "origin", "") or "event handler"
            entities = _locate_errors(
                where, handler.describe(), lambda: handler.handle(event, context)
            )
            for entity in entities or []:
                self._visit(entity)
        finally:
            context.pop_locals()

    def _visit_all(
        self, entities: Sequence[ContextEntity], scope: dict[str, Any]
    ) -> None:
        self.context.push_locals()
        self.context.extend_locals(scope)
        try:
            for entity in entities:
                self._visit(entity)
        finally:
            self.context.pop_locals()

    def _visit(self, entity: ContextEntity) -> None:
        found = _locate_errors(
            entity.origin or str(self.context.launch_file or "launch"),
            entity.describe(),
            lambda: entity.visit(self.context),
        )
        for each in found or []:
            self._visit(each)

    def _fail(self, error: LaunchError | CallbackError) -> None:
        cause = error.__cause__
        if isinstance(cause, LaunchError):
            error = cause
        if not isinstance(error, LaunchError):
            error = LaunchError(str(error))
        self.errors.append(error)
        _log.error("%s", error)
        self.context.events.clear()
        self.context.emit_event(Shutdown(reason="the launch failed"))


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
