"""Programs in this process: one in the main thread, or several that meet.

Several run in a thread each, with a context and a loop of their own, on one graph. What
Python has once a process they get once a program: ``sys.argv``, the default context.
"""

import asyncio
import contextvars
import signal
import sys
import threading
from collections.abc import Callable, Iterator, MutableSequence, Sequence
from contextlib import ExitStack, contextmanager
from functools import partial
from typing import Any, overload

from navette.ros2.names.blocking_calls import sleeping_lets_others_run
from navette.ros2.names.interrupts import ThreadInterrupt
from navette.ros2.names.program import (
    FAILED,
    INTERRUPTED,
    SUCCEEDED,
    Program,
    run,
)
from navette.ros2.names.startup_barrier import Readiness, watch_start
from navette.runtime.clock import Stopwatch
from navette.runtime.context import Scope, current_scope, new_graph
from navette.runtime.graph import Graph

# A program that was interrupted has this long before its context is shut down, and
# this long in all before it is left behind.
_GRACE_S = 0.5
_LONGEST_END_S = 5.0
_LOOK_S = 0.1

_argv: contextvars.ContextVar[list[str]] = contextvars.ContextVar("navette_argv")


def run_alone(program: Program) -> int:
    """Run in the main thread; Ctrl-C raises in it as Python does."""
    argv, sys.argv = sys.argv, program.argv
    over: list[int] = []
    watch_start(current_scope.get(), lambda: bool(over), Readiness().one_is_ready)
    try:
        # SIGTERM ends a program as ROS 2's does: its contexts are shut down.
        with (
            _on_path(program),
            _on_signal(signal.SIGTERM, _shut_down_everything),
            sleeping_lets_others_run(),
        ):
            return run(program)
    finally:
        over.append(1)
        sys.argv = argv


def run_together(programs: Sequence[Program]) -> int:
    """Run until all have ended; Ctrl-C and SIGTERM end all.

    One that fails ends the others as Ctrl-C does.

    Returns:
        The exit code of the first that failed, or 0.
    """
    graph = new_graph()
    readiness = Readiness(len(programs))
    running = [
        RunningProgram(program, graph, on_ready=readiness.one_is_ready)
        for program in programs
    ]
    wishes: list[_End] = []
    with ExitStack() as stack:
        stack.enter_context(program_threads())
        stack.enter_context(sleeping_lets_others_run())
        for program in programs:
            stack.enter_context(_on_path(program))
        for signum, how in _ENDS.items():
            stack.enter_context(_on_signal(signum, partial(wishes.append, how)))
        for each in running:
            each.start()
        failed = _wait_for_end(running, wishes)
        # A second signal changes nothing: ``timeout`` and shells send several.
        _end_all(running, wishes[0] if wishes else RunningProgram.interrupt)
    graph.close()
    return failed or _first_failure(running)


class RunningProgram:
    """A program in a thread of its own.

    Args:
        graph: where it meets the others.
        on_end: called in its thread, with its exit code.
        on_ready: called in another one, when its nodes are made and spin.
    """

    def __init__(
        self,
        program: Program,
        graph: Graph,
        on_end: Callable[[int], object] | None = None,
        on_ready: Callable[[], object] | None = None,
    ) -> None:
        self.program = program
        self.exit_code: int | None = None
        self.scope = Scope(graph)
        self._on_end = on_end
        self._on_ready = on_ready
        self._interrupt = ThreadInterrupt(self._wake)
        # A daemon: one that never ends must not keep the process.
        self._thread = threading.Thread(
            target=self._run, name=program.name, daemon=True
        )

    def start(self) -> None:
        self._thread.start()
        watch_start(self.scope, lambda: self.exit_code is not None, self._on_ready)

    @property
    def is_alive(self) -> bool:
        return self._thread.is_alive()

    def join(self, timeout_s: float | None = None) -> bool:
        """Wait for its end; tells whether it has come."""
        self._thread.join(timeout_s)
        return not self._thread.is_alive()

    def interrupt(self) -> None:
        """Raise KeyboardInterrupt in its main thread, as Ctrl-C does for a process."""
        self._interrupt.interrupt()

    def _wake(self) -> None:
        for context in tuple(self.scope.contexts):
            context.loop.wake()

    def shut_down(self) -> None:
        """Shut its contexts down, as SIGTERM does: its spins end, ``ok()`` is False."""
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
    """asyncio's default loop, which it gives to the main thread alone."""
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


def _wait_for_end(running: Sequence[RunningProgram], wishes: Sequence[_End]) -> int:
    """Until all have ended, one failed (returns its exit code), or there is a wish."""
    while not wishes and not _first_failure(running):
        alive = [each for each in running if each.is_alive]
        if not alive:
            break
        alive[0].join(_LOOK_S)
    return _first_failure(running)


def _first_failure(running: Sequence[RunningProgram]) -> int:
    return next((each.exit_code for each in running if each.exit_code), SUCCEEDED)


def _end_all(running: Sequence[RunningProgram], how: _End) -> None:
    watch = Stopwatch()
    for each in running:
        how(each)
    for each in running:
        each.join(max(0.0, _GRACE_S - watch.elapsed_s))
    # Again and again: one that began only now may still make a context.
    while watch.elapsed_s < _LONGEST_END_S and any(each.is_alive for each in running):
        for each in running:
            each.shut_down()
            each.join(_LOOK_S / len(running))
    for each in running:
        if each.is_alive:
            sys.stderr.write(
                f"navette: {each.program.name} does not end; left behind\n"
            )
            each.exit_code = INTERRUPTED


@contextmanager
def program_threads() -> Iterator[None]:
    """Give threads that a program starts its context and its ``sys.argv``.

    From 3.14 on Python can do this by itself (``thread_inherit_context``).
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
    """``sys.argv`` of the program that asks."""

    def __init__(self, outside: list[str]) -> None:
        self._outside = outside

    def _list(self) -> list[str]:
        return _argv.get(self._outside)

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
