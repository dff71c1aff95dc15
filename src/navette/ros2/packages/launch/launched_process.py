"""Managed process of a launch: its output is labelled, its life cycle causes events."""

import os
from typing import Any, Protocol

from navette.ros2.packages.launch.errors import LaunchError
from navette.ros2.packages.launch.events.process import (
    ProcessExited,
    ProcessStarted,
    ProcessStderr,
    ProcessStdout,
)
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.logging import get_logger
from navette.ros2.packages.launch.output import LabelledOutput
from navette.ros2.packages.launch.running import LaunchCommand
from navette.supervisor import (
    GracePeriods,
    ManagedProcess,
    ProcessError,
    ProcessHandle,
    ProcessState,
    RestartPolicy,
)


class ProcessAction(Protocol):
    """The action that a process belongs to."""

    log_cmd: bool
    origin: str

    def describe(self) -> str: ...

    def make_command(self, context: LaunchContext) -> LaunchCommand: ...

    def keep_output(self, stream: str, data: bytes) -> None: ...

    def complete(self, context: LaunchContext) -> None: ...

    def make_output(self, context: LaunchContext, label: str) -> LabelledOutput: ...


class LaunchedProcess(ManagedProcess):
    """Process of an action; a restart performs the action's substitutions again.

    Attributes:
        command: of the last start.
    """

    def __init__(
        self,
        action: ProcessAction,
        context: LaunchContext,
        policy: RestartPolicy,
        grace: GracePeriods,
    ) -> None:
        super().__init__("", policy, grace, context.loop)
        self.command: LaunchCommand | None = None
        self._action = action
        self._context = context
        self._last_pid = 0
        self._env: dict[str, str] = {}

    @property
    def details(self) -> dict[str, Any]:
        """What events report about the process."""
        assert self.command is not None, "started"
        return {
            "action": self._action,
            "name": self.command.label,
            "cmd": self.command.words,
            "cwd": self.command.cwd,
            "env": self._env,
            "pid": self._last_pid,
        }

    def spawn(self) -> ProcessHandle:
        self.command = self._action.make_command(self._context)
        self.label = self.command.label
        self._env = dict(os.environ if self.command.env is None else self.command.env)
        self._output = self._action.make_output(self._context, self.label)
        if self._action.log_cmd:
            get_logger(self.label).info("%s", " ".join(self.command.words))
        try:
            return self._context.runner.start(self.command)
        except ProcessError as error:
            where, entity = self._action.origin, self._action.describe()
            raise LaunchError.at(where, entity, error) from error

    def on_started(self) -> None:
        self._last_pid = self.pid or 0
        get_logger(self.label).info("process started with pid [%d]", self._last_pid)
        self._context.emit_event_sync(ProcessStarted(**self.details))

    def on_output(self, stream: str, data: bytes) -> None:
        output, details = self._output, self.details
        kind = ProcessStdout if stream == "stdout" else ProcessStderr

        def report() -> None:
            output.write(stream, data)
            self._action.keep_output(stream, data)
            self._context.emit_event_sync(kind(text=data, **details))

        self.loop.call_soon_threadsafe(report, self.label)

    def on_escalated(self, signal_name: str) -> None:
        get_logger(self.label).warning("does not end; sending %s", signal_name)

    def on_exited(self, code: int) -> None:
        self._output.close()
        self._log_exit(code)
        self._context.emit_event_sync(ProcessExited(returncode=code, **self.details))

    def _log_exit(self, code: int) -> None:
        log, pid = get_logger(self.label), self._last_pid
        if code == 0:
            log.info("process has finished cleanly [pid %d]", pid)
        elif self.is_stopping:
            log.info("process has ended [pid %d, exit code %d]", pid, code)
        else:
            self._context.failed_labels.append(self.label)
            words = " ".join(self.details["cmd"])
            log.error(
                "process has died [pid %d, exit code %d, cmd '%s']", pid, code, words
            )

    def on_state_changed(self) -> None:
        """Keep the launch running until the process has ended for good."""
        if self.is_alive or self.state is ProcessState.RESTARTING:
            self._context.busy.add(self)
        elif self in self._context.busy:
            self._context.busy.discard(self)
            self._action.complete(self._context)
