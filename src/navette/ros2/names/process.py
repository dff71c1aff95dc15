"""Run programs in this process: one in the main thread, or several in threads.

Each of several programs has a thread, a context and a loop; all share one graph. State
that Python has once per process exists once per program: ``sys.argv`` and the default
context.
"""

import contextvars
import signal
import sys
import threading
from collections.abc import Callable, Iterator, MutableSequence, Sequence
from contextlib import ExitStack, contextmanager
from functools import partial
from typing import Any, overload

from navette.ros2.names.blocking_calls import cooperative_blocking_calls
from navette.ros2.names.interrupts import ThreadInterrupt
from navette.ros2.names.program import (
    FAILED,
    INTERRUPTED,
    SUCCEEDED,
    Program,
    run,
)
from navette.ros2.names.startup_barrier import StartupBarrier, watch_startup
from navette.runtime.clock import Stopwatch
from navette.runtime.context import Scope, current_scope, new_graph
from navette.runtime.graph import Graph

# Time from a program's interrupt to the shutdown of its contexts, and to giving up.
_GRACE_S = 0.5
_LONGEST_END_S = 5.0
_POLL_S = 0.1

_argv: contextvars.ContextVar[list[str]] = contextvars.ContextVar("navette_argv")


def run_alone(program: Program) -> int:
    """Run in the main thread; Ctrl-C raises KeyboardInterrupt, as usual in Python."""
    argv, sys.argv = sys.argv, program.argv
    ended = threading.Event()
    watch_startup(current_scope.get(), ended.is_set, StartupBarrier().program_ready)
    try:
        # As in ROS 2, SIGTERM shuts the contexts down.
        with (
            _on_path(program),
            _on_signal(signal.SIGTERM, _shut_down_everything),
            cooperative_blocking_calls(),
        ):
            return run(program)
    finally:
        ended.set()
        sys.argv = argv


def run_together(programs: Sequence[Program]) -> int:
    """Run until all programs have ended; Ctrl-C and SIGTERM end all.

    A program that fails ends the others in the same manner as Ctrl-C.

    Returns:
        The exit code of the first program that failed, or 0.
    """
    graph = new_graph()
    barrier = StartupBarrier(len(programs))
    running = [
        RunningProgram(program, graph, on_ready=barrier.program_ready)
        for program in programs
    ]
    requests: list[_End] = []
    with ExitStack() as stack:
        stack.enter_context(program_threads())
        stack.enter_context(cooperative_blocking_calls())
        for program in programs:
            stack.enter_context(_on_path(program))
        for signum, how in _ENDS.items():
            stack.enter_context(_on_signal(signum, partial(requests.append, how)))
        for each in running:
            each.start()
        failed = _wait_for_end(running, requests)
        # Only the first signal counts: ``timeout`` and shells send several.
        _end_all(running, requests[0] if requests else RunningProgram.interrupt)
    graph.close()
    return failed or _first_failure(running)


OnProgramEnd = Callable[[int], object]
"""Called in a program's thread with its exit code."""

OnProgramReady = Callable[[], object]
"""Called in another thread when a program's nodes exist and spin."""


class RunningProgram:
    """A program in a thread.

    Args:
        graph: graph that the programs share.
    """

    def __init__(
        self,
        program: Program,
        graph: Graph,
        *,
        on_end: OnProgramEnd | None = None,
        on_ready: OnProgramReady | None = None,
    ) -> None:
        self.program = program
        self.exit_code: int | None = None
        self.scope = Scope(graph)
        self._on_end = on_end
        self._on_ready = on_ready
        self._interrupt = ThreadInterrupt(wake=self._wake)
        # A daemon, so that the process can end before the program does.
        self._thread = threading.Thread(
            target=self._run, name=program.name, daemon=True
        )

    def start(self) -> None:
        self._thread.start()
        watch_startup(self.scope, lambda: self.exit_code is not None, self._on_ready)

    @property
    def is_alive(self) -> bool:
        return self._thread.is_alive()

    def join(self, timeout_s: float | None = None) -> bool:
        """Wait for the program's end; return whether it has ended."""
        self._thread.join(timeout_s)
        return not self._thread.is_alive()

    def interrupt(self) -> None:
        """Raise KeyboardInterrupt in the program's thread, as Ctrl-C in a process."""
        self._interrupt.interrupt()

    def _wake(self) -> None:
        for context in tuple(self.scope.contexts):
            context.loop.wake()

    def shut_down(self) -> None:
        """Shut the program's contexts down, as SIGTERM does in a process."""
        for context in tuple(self.scope.contexts):
            context.try_shutdown()

    def _run(self) -> None:
        current_scope.set(self.scope)
        _argv.set(self.program.argv)
        try:
            with _main_thread_event_loop():
                code = self._interrupt.run(lambda: run(self.program))
            self.exit_code = INTERRUPTED if code is None else code
        finally:
            self.exit_code = FAILED if self.exit_code is None else self.exit_code
            self.shut_down()
            if self._on_end is not None:
                self._on_end(self.exit_code)


@contextmanager
def _main_thread_event_loop() -> Iterator[None]:
    """Give this thread a default asyncio loop; asyncio makes one in the main thread."""
    import asyncio  # later: one program in the main thread needs none

    loop = asyncio.new_event_loop()
    asyncio.set_event_loop(loop)
    try:
        yield
    finally:
        asyncio.set_event_loop(None)
        loop.close()


_End = Callable[[RunningProgram], None]
_ENDS: dict[signal.Signals, _End] = {
    signal.SIGINT: RunningProgram.interrupt,
    signal.SIGTERM: RunningProgram.shut_down,
}


def _wait_for_end(running: Sequence[RunningProgram], requests: Sequence[_End]) -> int:
    """Wait until all have ended, one has failed, or a signal requests the end.

    Returns:
        The exit code of the program that failed, or 0.
    """
    while not requests and not _first_failure(running):
        alive = [each for each in running if each.is_alive]
        if not alive:
            break
        alive[0].join(_POLL_S)
    return _first_failure(running)


def _first_failure(running: Sequence[RunningProgram]) -> int:
    return next((each.exit_code for each in running if each.exit_code), SUCCEEDED)


def _end_all(running: Sequence[RunningProgram], how: _End) -> None:
    watch = Stopwatch()
    for each in running:
        how(each)
    for each in running:
        each.join(max(0.0, _GRACE_S - watch.elapsed_s))
    # Repeatedly: a program that has just begun may create a context after a shutdown.
    while watch.elapsed_s < _LONGEST_END_S and any(each.is_alive for each in running):
        for each in running:
            each.shut_down()
            each.join(_POLL_S / len(running))
    for each in running:
        if each.is_alive:
            sys.stderr.write(f"navette: {each.program.name} does not end; abandoned\n")
            each.exit_code = INTERRUPTED


@contextmanager
def program_threads() -> Iterator[None]:
    """Give the threads that a program starts its context and its ``sys.argv``.

    Python 3.14 and later can do the same (``thread_inherit_context``).
    """
    argv, plain_start = sys.argv, threading.Thread.start

    def start(thread: threading.Thread) -> None:
        thread.run = _inheriting(thread.run)  # type: ignore[method-assign]
        plain_start(thread)

    sys.argv = _ProgramArguments(argv)  # type: ignore[assignment]
    threading.Thread.start = start  # type: ignore[method-assign, assignment]
    try:
        yield
    finally:
        threading.Thread.start = plain_start  # type: ignore[method-assign]
        sys.argv = argv


def _inheriting(function: Callable[[], None]) -> Callable[[], None]:
    context = contextvars.copy_context()
    return lambda: context.run(function)


class _ProgramArguments(MutableSequence[str]):
    """``sys.argv`` of the program that reads it.

    Args:
        default: the arguments in threads that belong to no program.
    """

    def __init__(self, default: list[str]) -> None:
        self._default = default

    def _list(self) -> list[str]:
        return _argv.get(self._default)

    def __len__(self) -> int:
        return len(self._list())

    @overload
    def __getitem__(self, index: int) -> str: ...
    @overload
    def __getitem__(self, index: slice) -> list[str]: ...
    def __getitem__(self, index: Any) -> Any:
        return self._list()[index]

    def __setitem__(self, index: Any, value: Any) -> None:
        self._list()[index] = value

    def __delitem__(self, index: int | slice) -> None:
        del self._list()[index]

    def insert(self, index: int, value: str) -> None:
        self._list().insert(index, value)

    def __eq__(self, other: object) -> bool:
        return self._list() == (list(other) if isinstance(other, Sequence) else other)

    def __repr__(self) -> str:
        return repr(self._list())

    __hash__ = None  # type: ignore[assignment]


@contextmanager
def _on_path(program: Program) -> Iterator[None]:
    folders = [str(path) for path in program.path]
    sys.path[:0] = folders
    try:
        yield
    finally:
        for folder in folders:
            if folder in sys.path:
                sys.path.remove(folder)


@contextmanager
def _on_signal(signum: signal.Signals, react: Callable[[], object]) -> Iterator[None]:
    before = signal.signal(signum, lambda *_: react() and None)
    try:
        yield
    finally:
        signal.signal(signum, before)


def _shut_down_everything() -> None:
    for context in tuple(current_scope.get().contexts):
        context.try_shutdown()
