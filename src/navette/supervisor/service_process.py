"""Process of a service: its output goes to the project's log."""

import os
import threading
from collections.abc import Callable, Mapping
from typing import Any

from navette.runtime.loop import EventLoop
from navette.supervisor.child import INTERRUPT, TERMINATE, ChildProcess
from navette.supervisor.lines import LineSplitter
from navette.supervisor.log_store import LogStore
from navette.supervisor.managed_process import ManagedProcess
from navette.supervisor.process_manager import (
    ProcessError,
    ProcessManager,
    StartOptions,
)
from navette.supervisor.service_config import ProcessConfig, ProcessState
from navette.supervisor.terminator import GracePeriods

READY_VARIABLE = "NAVETTE_READY_FD"
# A process that never reports readiness counts as ready after this time.
_READY_TIMEOUT_S = 10.0


OnStateChange = Callable[[], None]
"""Called after every change of a process's state."""


class ServiceProcess(ManagedProcess):
    """A managed process of a service.

    Args:
        environ: environment that the process inherits.
    """

    def __init__(
        self,
        spec: ProcessConfig,
        environ: Mapping[str, str],
        *,
        manager: ProcessManager,
        loop: EventLoop,
        log: LogStore,
        on_change: OnStateChange,
    ) -> None:
        grace = GracePeriods(spec.stop_timeout_s, spec.stop_timeout_s)
        super().__init__(spec.label, spec.restart, grace, loop)
        self.spec = spec
        self._env = {**environ, **spec.env}
        self._manager = manager
        self._log = log
        self._on_change = on_change
        self._lines = LineSplitter()
        self._since_ns = loop.clock.now_ns

    @property
    def is_ready(self) -> bool:
        """Whether services that depend on this process may start."""
        return self.state in (ProcessState.RUNNING, ProcessState.ENDED)

    @property
    def state_after_start(self) -> ProcessState:
        reports = self.spec.reports_ready
        return ProcessState.STARTING if reports else ProcessState.RUNNING

    def status(self) -> dict[str, Any]:
        """Return the status as JSON values."""
        return {
            "name": self.spec.name,
            "label": self.label,
            "state": self.state.value,
            "pid": self.pid,
            "seconds": (self.loop.clock.now_ns - self._since_ns) / 1e9,
            "restarts": self.restarts,
            "reason": self.reason,
            "domain": self._env.get("ROS_DOMAIN_ID") or "0",
        }

    def start(self) -> None:
        try:
            super().start()
        except ProcessError as error:
            self.reason = str(error)
            self.set_state(ProcessState.FAILED)
            return
        if self.state is ProcessState.STARTING:
            self.call_after(_READY_TIMEOUT_S, self._set_ready)

    def spawn(self) -> ChildProcess:
        self._lines = LineSplitter()
        pipe = os.pipe() if self.spec.reports_ready else None
        ready = {} if pipe is None else {READY_VARIABLE: str(pipe[1])}
        options = StartOptions(
            cwd=self.spec.cwd,
            env={**self._env, **ready},
            shell=self.spec.shell,
            merge_streams=True,
            pass_fds=() if pipe is None else (pipe[1],),
        )
        try:
            child = self._manager.start(self.spec.argv, options)
        except ProcessError:
            if pipe is not None:
                os.close(pipe[0])
            raise
        finally:
            if pipe is not None:
                os.close(pipe[1])
        if pipe is not None:
            threading.Thread(
                target=self._await_ready, args=(pipe[0], child), daemon=True
            ).start()
        return child

    def _await_ready(self, pipe: int, child: ChildProcess) -> None:
        def report() -> None:
            if self.pid == child.pid:
                self._set_ready()

        with os.fdopen(pipe, "rb") as file:
            if file.read():
                self.loop.call_soon_threadsafe(report, self.label)

    def _set_ready(self) -> None:
        if self.state is ProcessState.STARTING:
            self.cancel_timer()
            self.set_state(ProcessState.RUNNING)

    def on_started(self) -> None:
        self._log_event(f"started (pid {self.pid})")

    def on_output(self, stream: str, data: bytes) -> None:
        self._log_lines(self._lines.feed(data))

    def on_escalated(self, signal_name: str) -> None:
        self._log_event(f"does not end; sending {signal_name}")

    def on_exited(self, code: int) -> None:
        self._log_lines(self._lines.finish())
        if self.is_stopping:
            expected = code in (0, -INTERRUPT, -TERMINATE)
            self._log_event("stopped" if expected else f"stopped ({self.reason})")

    def set_state(self, state: ProcessState) -> None:
        became_ready = (self.state, state) == (
            ProcessState.STARTING,
            ProcessState.RUNNING,
        )
        if not became_ready:
            self._since_ns = self.loop.clock.now_ns
        super().set_state(state)

    def on_state_changed(self) -> None:
        if self.state in (ProcessState.ENDED, ProcessState.FAILED):
            self._log_event(self.reason)
        elif self.state is ProcessState.RESTARTING:
            self._log_event(f"{self.reason}; restart in {self.restart_delay_s:g} s")
        self._on_change()

    def _log_lines(self, lines: list[str]) -> None:
        if lines:
            self._log.write(self.spec.service, self.spec.name, lines)

    def _log_event(self, text: str) -> None:
        self._log.write(self.spec.service, self.spec.name, [text], event=True)
