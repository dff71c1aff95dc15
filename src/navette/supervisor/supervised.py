"""One process of a module: started, watched, restarted, ended."""

import os
import threading
from collections.abc import Callable, Mapping
from typing import Any

from navette.runtime.events import Call
from navette.runtime.loop import EventLoop
from navette.supervisor import (
    INTERRUPT,
    TERMINATE,
    ChildProcess,
    Ending,
    Keeper,
    LineCutter,
    Patience,
    ProcessError,
    StartOptions,
    describe_exit,
)
from navette.supervisor.log_book import LogBook
from navette.supervisor.specs import ALIVE, ProcessSpec, State

READY_VARIABLE = "NAVETTE_READY_FD"
# A program that never says so is taken for ready after this long.
_READY_AT_LAST_S = 10.0


class Supervised:
    """A process and its fate; everything here happens on the loop.

    Args:
        environ: what it inherits.
        on_change: called after every change of state.
    """

    def __init__(
        self,
        spec: ProcessSpec,
        environ: Mapping[str, str],
        keeper: Keeper,
        loop: EventLoop,
        log: LogBook,
        on_change: Callable[[], None],
    ) -> None:
        self.spec = spec
        self.state = State.WAITING
        self.reason = ""
        self.restarts = 0
        self._environ = environ
        self._keeper = keeper
        self._loop = loop
        self._log = log
        self._on_change = on_change
        self._run: _Run | None = None
        self._since_ns = loop.clock.now_ns
        self._in_a_row = 0
        self._ending: Ending | None = None
        self._later: Call | None = None

    @property
    def is_alive(self) -> bool:
        return self.state in ALIVE

    @property
    def is_ready(self) -> bool:
        """Whether those who need it may start."""
        return self.state in (State.RUNNING, State.ENDED)

    def start(self) -> None:
        """Start it, whatever became of it before."""
        self._cancel()
        self._ending = None
        self.reason = ""
        run = _Run(self)
        try:
            run.start(self._keeper, self._environ)
        except ProcessError as error:
            self._say(str(error))
            self.reason = str(error)
            self._set(State.FAILED)
            return
        self._run = run
        self._say(f"started (pid {run.pid})")
        run.begin()
        self._set(State.STARTING if self.spec.tells_ready else State.RUNNING)
        if self.spec.tells_ready:
            self._later = self._after(_READY_AT_LAST_S, self._ready)

    def stop(self) -> None:
        """Ask it to end; it gets ever clearer signals until it does."""
        self._cancel()
        if not self.is_alive:
            if self.state in (State.WAITING, State.PAUSING):
                self._set(State.STOPPED)
            return
        if self._ending is None and self._run is not None:
            seconds = self.spec.stop_timeout_s
            self._ending = Ending(
                Patience(seconds, seconds),
                self._run.signal,
                self._after,
                lambda name: self._say(f"does not end; sending {name}"),
            )
            self._set(State.STOPPING)
            self._ending.go_on()

    def status(self) -> dict[str, Any]:
        """For those who ask; plain values."""
        run = self._run if self.is_alive else None
        return {
            "name": self.spec.name,
            "label": self.spec.label,
            "state": self.state.value,
            "pid": None if run is None else run.pid,
            "seconds": (self._loop.clock.now_ns - self._since_ns) / 1e9,
            "restarts": self.restarts,
            "reason": self.reason,
            "domain": self._domain,
        }

    @property
    def _domain(self) -> str:
        """The ROS domain of its nodes, as its environment says."""
        environ = {**self._environ, **self.spec.env}
        return environ.get("ROS_DOMAIN_ID") or "0"

    # -- what happens to it --------------------------------------------------------

    def heard(self, run: "_Run", lines: list[str]) -> None:
        """From any thread: it wrote."""
        self._log.write(self.spec.module, self.spec.name, lines)

    def soon(self, function: Callable[[], None]) -> None:
        """From any thread: do it on the loop."""
        self._loop.call_soon_threadsafe(function, self.spec.label)

    def ready(self, run: "_Run") -> None:
        if run is self._run:
            self._ready()

    def exited(self, run: "_Run", code: int) -> None:
        if run is not self._run:
            return
        self._cancel()
        self._run = None
        ran_s = (self._loop.clock.now_ns - run.started_ns) / 1e9
        self.reason = describe_exit(code)
        if self._ending is not None:
            self._ending.cancel()
            usual = code in (0, -INTERRUPT, -TERMINATE)
            self._say("stopped" if usual else f"stopped ({self.reason})")
            self._set(State.STOPPED)
        elif self.spec.restart.wants(code):
            self._restart_later(ran_s)
        else:
            self._say(self.reason)
            self._set(State.FAILED if code else State.ENDED)

    def _restart_later(self, ran_s: float) -> None:
        policy = self.spec.restart
        if ran_s >= policy.good_s:
            self._in_a_row = 0
        if self._in_a_row >= policy.limit:
            self.reason += f"; given up after {self._in_a_row} restarts"
            self._say(self.reason)
            self._set(State.FAILED)
            return
        delay_s = policy.delay_before(self._in_a_row)
        self._in_a_row += 1
        self._say(f"{self.reason}; again in {delay_s:g} s")
        self._set(State.PAUSING)
        self._later = self._after(delay_s, self._restart)

    def _restart(self) -> None:
        self.restarts += 1
        self.start()

    def _ready(self) -> None:
        if self.state is State.STARTING:
            self._cancel()
            self._set(State.RUNNING)

    def _set(self, state: State) -> None:
        if state is not State.RUNNING or self.state is not State.STARTING:
            self._since_ns = self._loop.clock.now_ns
        self.state = state
        self._on_change()

    def _say(self, text: str) -> None:
        self._log.write(self.spec.module, self.spec.name, [text], event=True)

    def _after(self, seconds: float, function: Callable[[], None]) -> Call:
        at_ns = self._loop.clock.now_ns + round(seconds * 1e9)
        return self._loop.call_at(at_ns, function, self.spec.label)

    def _cancel(self) -> None:
        if self._later is not None:
            self._later.cancel()
            self._later = None

    @property
    def now_ns(self) -> int:
        return self._loop.clock.now_ns


class _Run:
    """One run of the process; what it says after its end concerns nobody."""

    def __init__(self, owner: Supervised) -> None:
        self._owner = owner
        self._cutter = LineCutter()
        self._child: ChildProcess | None = None
        self._has_begun = threading.Event()
        self.started_ns = owner.now_ns

    @property
    def pid(self) -> int:
        assert self._child is not None, "it was started"
        return self._child.pid

    def start(self, keeper: Keeper, environ: Mapping[str, str]) -> None:
        spec = self._owner.spec
        env = {**environ, **spec.env}
        pipes = os.pipe() if spec.tells_ready else ()
        if pipes:
            env[READY_VARIABLE] = str(pipes[1])
        options = StartOptions(
            cwd=spec.cwd,
            env=env,
            shell=spec.shell,
            one_stream=True,
            pass_fds=tuple(pipes[1:]),
        )
        try:
            self._child = keeper.start(spec.words, self, options)
        except ProcessError:
            for pipe in pipes:
                os.close(pipe)
            raise
        if pipes:
            os.close(pipes[1])
            threading.Thread(target=self._wait, args=(pipes[0],), daemon=True).start()

    def begin(self) -> None:
        """Its start has been noted: what it wrote, however soon, stands behind that."""
        self._has_begun.set()

    def signal(self, number: int) -> None:
        if self._child is not None:
            self._child.signal(number)

    def output(self, stream: str, data: bytes) -> None:
        self._has_begun.wait()
        lines = self._cutter.feed(data)
        if lines:
            self._owner.heard(self, lines)

    def exited(self, code: int) -> None:
        self._has_begun.wait()
        lines = self._cutter.finish()
        if lines:
            self._owner.heard(self, lines)
        self._owner.soon(lambda: self._owner.exited(self, code))

    def _wait(self, pipe: int) -> None:
        with os.fdopen(pipe, "rb") as file:
            if file.read():
                self._owner.soon(lambda: self._owner.ready(self))
