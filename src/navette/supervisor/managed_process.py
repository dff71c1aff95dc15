"""Managed process: started, restarted by a policy, and terminated, on one loop."""

from abc import ABC, abstractmethod
from collections.abc import Callable

from navette.runtime.events import Call
from navette.runtime.loop import EventLoop
from navette.supervisor.child import ProcessHandle
from navette.supervisor.exit_code import describe_exit
from navette.supervisor.service_config import ALIVE, ProcessState, RestartPolicy
from navette.supervisor.terminator import GracePeriods, Terminator


class ManagedProcess(ABC):
    """Life cycle of a process; subclasses define how it starts and what they report.

    ``navette up`` and ``navette launch`` both run their processes with this class. All
    methods run on the loop, except :meth:`on_output`.

    Attributes:
        restarts: number of automatic restarts.
        restart_delay_s: delay before the last restart.
        exit_code: of the last run; None while it runs.
        reason: why the process is not running, in words.
    """

    def __init__(
        self, label: str, policy: RestartPolicy, grace: GracePeriods, loop: EventLoop
    ) -> None:
        self.label = label
        self.state = ProcessState.WAITING
        self.restarts = 0
        self.restart_delay_s = 0.0
        self.exit_code: int | None = None
        self.reason = ""
        self.loop = loop
        self._policy = policy
        self._grace = grace
        self._run: _Run | None = None
        self._attempts = 0
        self._terminator: Terminator | None = None
        self._timer: Call | None = None

    # -- defined by subclasses ---------------------------------------------------

    @abstractmethod
    def spawn(self) -> ProcessHandle:
        """Start the process; exceptions reach the caller of :meth:`start`."""

    @abstractmethod
    def on_started(self) -> None:
        """Handle a start."""

    @abstractmethod
    def on_output(self, stream: str, data: bytes) -> None:
        """Handle output; called on any thread."""

    @abstractmethod
    def on_escalated(self, signal_name: str) -> None:
        """Handle that the process ignored a signal and gets a stronger one."""

    @abstractmethod
    def on_exited(self, code: int) -> None:
        """Handle an exit, before the restart policy applies."""

    @abstractmethod
    def on_state_changed(self) -> None:
        """Handle a change of :attr:`state`."""

    # -- operations --------------------------------------------------------------

    @property
    def is_alive(self) -> bool:
        return self.state in ALIVE

    @property
    def is_stopping(self) -> bool:
        """Whether the process was requested to stop."""
        return self._terminator is not None

    @property
    def pid(self) -> int | None:
        return None if self._run is None else self._run.handle.pid

    def start(self) -> None:
        """Start the process, whatever its state was."""
        self.cancel_timer()
        self._terminator = None
        self.exit_code = None
        self.reason = ""
        run = self._run = _Run(self, self.spawn())
        self.on_started()
        self.set_state(self.state_after_start)
        run.handle.watch(run)

    @property
    def state_after_start(self) -> ProcessState:
        return ProcessState.RUNNING

    def stop(self) -> None:
        """Terminate the process, or cancel its pending restart."""
        self.cancel_timer()
        if self.state in (ProcessState.WAITING, ProcessState.RESTARTING):
            self.set_state(ProcessState.STOPPED)
        elif self.is_alive and self._terminator is None:
            self._terminator = Terminator(self._grace, self, self.loop)
            self.set_state(ProcessState.STOPPING)
            self._terminator.send_next()

    def escalate(self) -> None:
        """Stop the process; if it is stopping already, send the next signal now."""
        if self._terminator is None:
            self.stop()
        elif self.is_alive:
            self._terminator.send_next()

    def signal(self, number: int) -> None:
        """Send a signal; ignored while the process does not run."""
        if self._run is not None:
            self._run.handle.signal(number)

    def write(self, data: bytes) -> None:
        """Write to the standard input; ignored while the process does not run."""
        if self._run is not None:
            self._run.handle.write(data)

    # -- life cycle --------------------------------------------------------------

    def set_state(self, state: ProcessState) -> None:
        self.state = state
        self.on_state_changed()

    def call_after(self, seconds: float, function: Callable[[], None]) -> None:
        """Call ``function`` later, in place of the pending call."""
        self.cancel_timer()
        at_ns = self.loop.clock.now_ns + round(seconds * 1e9)
        self._timer = self.loop.call_at(at_ns, function, self.label)

    def cancel_timer(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def exited(self, run: "_Run", code: int) -> None:
        """Apply the restart policy to the exit of ``run``."""
        if run is not self._run:
            return
        self.cancel_timer()
        self.exit_code = code
        self.reason = describe_exit(code)
        if self._terminator is not None:
            self._terminator.cancel()
        self.on_exited(code)
        self._run = None
        if self._terminator is not None:
            self.set_state(ProcessState.STOPPED)
        elif self._policy.applies_to(code):
            self._schedule_restart((self.loop.clock.now_ns - run.started_ns) / 1e9)
        else:
            self.set_state(ProcessState.FAILED if code else ProcessState.ENDED)

    def _schedule_restart(self, ran_s: float) -> None:
        policy = self._policy
        if ran_s >= policy.window_s:
            self._attempts = 0
        if self._attempts >= policy.max_attempts:
            self.reason += f"; gave up after {self._attempts} restarts"
            self.set_state(ProcessState.FAILED)
            return
        self.restart_delay_s = policy.delay_before(self._attempts)
        self._attempts += 1
        self.set_state(ProcessState.RESTARTING)
        self.call_after(self.restart_delay_s, self._restart)

    def _restart(self) -> None:
        self.restarts += 1
        self.start()


class _Run:
    """Listener of one run of a process."""

    def __init__(self, process: ManagedProcess, handle: ProcessHandle) -> None:
        self.handle = handle
        self.started_ns = process.loop.clock.now_ns
        self._process = process

    def output(self, stream: str, data: bytes) -> None:
        self._process.on_output(stream, data)

    def exited(self, code: int) -> None:
        process = self._process
        process.loop.call_soon_threadsafe(
            lambda: process.exited(self, code), process.label
        )
