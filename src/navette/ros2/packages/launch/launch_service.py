"""The launch service: visits entities, hands events to handlers, ends in order."""

import os
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from typing import Any

from navette.errors import CallbackError
from navette.ros2.packages.launch.errors import LaunchError
from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.events import Shutdown
from navette.ros2.packages.launch.launch_context import LaunchContext, VisitEvent
from navette.ros2.packages.launch.launch_description import LaunchDescription
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
)
from navette.ros2.packages.launch.launched_process import LaunchedProcess
from navette.ros2.packages.launch.logging import console, get_logger
from navette.ros2.packages.launch.running import Runner
from navette.ros2.packages.launch.subprocesses import SubprocessRunner
from navette.runtime import SystemClock
from navette.runtime.loop import EventLoop

SUCCEEDED = 0
FAILED = 1

_log = get_logger("launch")


class LaunchService:
    """Runs launch descriptions until everything that they started has ended.

    Args:
        argv: ``name:=value`` arguments.
        noninteractive: nobody is at the terminal.
        debug: log what happens inside.
        loop: runs events and timers (default: one on the system's clock).
        runner: starts commands (default: one process each).
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
        self._ending = False
        self._stands_still = False
        self._shutdown_when_idle = True
        self.context = LaunchContext(
            argv=argv,
            noninteractive=noninteractive,
            loop=loop or EventLoop(SystemClock()),
            runner=runner or SubprocessRunner(),
        )
        self._on_started: list[Callable[[], None]] = []
        # Whoever brings a runner has a console of its own as well.
        self._console = console(debug=debug) if runner is None else nullcontext()

    @property
    def event_loop(self) -> EventLoop:
        """The loop that runs events and timers."""
        return self.context.loop

    def include_launch_description(self, description: LaunchDescription) -> None:
        """Visit a description when the service runs."""
        self.context.visit_later([description])

    def emit_event(self, event: Event) -> None:
        """From any thread: let the handlers have an event."""
        self.context.emit_from_thread(event)

    def check_after_start(self, check: Callable[[], None]) -> None:
        """Call ``check`` once the descriptions have been visited; it may raise."""
        self._on_started.append(check)

    def shutdown(self, force_sync: bool = False, reason: str = "asked to") -> None:
        """From any thread: end everything, then :meth:`run` returns."""
        self.emit_event(Shutdown(reason=reason))

    def hurry(self) -> None:
        """From any thread: end what is still running with more force."""
        self.context.loop.call_soon_threadsafe(self._hurry, "hurry")

    def run(self, *, shutdown_when_idle: bool = True) -> int:
        """Run to the end; 0, or 1 if the launch failed or a process died.

        A failed launch ends what it has started.
        """
        with self._console:
            return self._run(shutdown_when_idle=shutdown_when_idle)

    def _run(self, *, shutdown_when_idle: bool) -> int:
        context = self.context
        context.notes["first environment"] = dict(os.environ)
        self._shutdown_when_idle = shutdown_when_idle
        try:
            while not self._is_over():
                try:
                    self._work()
                    context.loop.run(done=lambda: bool(context.events) or self._idle())
                    self._notice_standstill()
                except CallbackError as error:
                    self._fail(error)
        finally:
            context.restore_environment(context.notes["first environment"])
            context.close()
            context.runner.close()
        return FAILED if self.errors or context.failed_labels else SUCCEEDED

    def _hurry(self) -> None:
        for item in tuple(self.context.busy):
            if isinstance(item, LaunchedProcess):
                item.escalate()

    # -- inside ------------------------------------------------------------------

    def _idle(self) -> bool:
        context = self.context
        if context.events or context.busy:
            return False
        return self._ending or self._shutdown_when_idle

    def _is_over(self) -> bool:
        """Idle; before the end comes a Shutdown event, for those who wait for it."""
        context = self.context
        if self._stands_still and self._ending:
            return True
        if not self._idle():
            return False
        if self._ending:
            return True
        context.emit_event(Shutdown(reason="everything has ended", due_to_sigint=False))
        return False

    def _notice_standstill(self) -> None:
        """On a virtual clock, a run with nothing left to happen stays like that."""
        context = self.context
        nothing_left = context.loop.clock.is_virtual and not context.events
        self._stands_still = nothing_left and not self._idle()
        if self._stands_still and not self._ending:
            context.emit_event(Shutdown(reason="nothing is left to happen"))

    def _work(self) -> None:
        """Handle what has happened so far."""
        context = self.context
        while context.events:
            event = context.events.popleft()
            try:
                self._handle(event)
                if not context.events:
                    self._check_started()
            except LaunchError as error:
                self._fail(error)

    def _check_started(self) -> None:
        checks, self._on_started = self._on_started, []
        for check in checks:
            _guarded("command line", "launch arguments", check)

    def _handle(self, event: Event) -> None:
        context = self.context
        if isinstance(event, Shutdown):
            if self._ending:
                return
            self._ending = context.is_shutdown = True
            context.extend_globals({"event": event})
        if isinstance(event, VisitEvent):
            context.push_locals()
            context.extend_locals(event.scope)
            try:
                for entity in event.entities:
                    self._visit(entity)
            finally:
                context.pop_locals()
            return
        for handler in context.event_handlers:
            # An earlier answer may have taken this one away.
            if context.is_registered(handler) and handler.matches(event):
                self._answer(handler, event)

    def _answer(self, handler: Any, event: Event) -> None:
        context = self.context
        if handler.handle_once:
            context.unregister_event_handler(handler)
        context.push_locals()
        context.extend_locals({"event": event})
        try:
            where = getattr(handler, "origin", "") or "event handler"
            entities = _guarded(
                where, handler.describe(), lambda: handler.handle(event, context)
            )
            for entity in entities or []:
                self._visit(entity)
        finally:
            context.pop_locals()

    def _visit(self, entity: LaunchDescriptionEntity) -> None:
        found = _guarded(
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


def _guarded(where: str, entity: str, work: Callable[[], Any]) -> Any:
    """Do ``work``; what it raises becomes an error that says where.

    Launch files are programs of their own: whatever they raise is theirs.
    """
    try:
        return work()
    except LaunchError:
        raise
    except Exception as error:
        raise LaunchError.at(where, entity, error) from error
