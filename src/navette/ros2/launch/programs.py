"""Runs Python programs in this process, a thread each; other commands as processes."""

import os
import sys
from collections.abc import Callable
from contextlib import ExitStack
from contextvars import ContextVar
from dataclasses import replace
from queue import SimpleQueue
from threading import Lock

from navette.ros2.launch.streams import program_output, program_streams
from navette.ros2.names.blocking_calls import cooperative_blocking_calls
from navette.ros2.names.process import RunningProgram, program_threads
from navette.ros2.names.program import Program, entry_point, script
from navette.ros2.packages.launch.logging import get_logger
from navette.ros2.packages.launch.running import (
    INTERRUPT,
    KILL,
    Command,
    Listener,
    PythonProgram,
    Running,
)
from navette.ros2.packages.launch.subprocesses import SubprocessRunner
from navette.runtime.context import new_graph

LEFT_BEHIND = -KILL

program_input: ContextVar["SimpleQueue[bytes] | None"] = ContextVar(
    "program_input", default=None
)
"""What is written to a program's standard input, piece by piece; None: nothing is."""

_log = get_logger("launch")


class InProcessRunner:
    """Python programs as threads that meet on one graph; the rest as processes."""

    def __init__(self) -> None:
        self.graph = new_graph()
        self._processes = SubprocessRunner()
        self._stack = ExitStack()
        # What the programs start goes with the launch as well.
        self._stack.enter_context(self._processes.keeper.keeping_all())
        self._stack.enter_context(program_threads())
        self._stack.enter_context(cooperative_blocking_calls())
        self._stack.enter_context(program_streams())

    def start(self, command: Command, listener: Listener) -> Running:
        if command.program is None:
            return self._processes.start(command, listener)
        if command.own_process:
            _log.warning(
                "%s runs in a process of its own (prefix, cwd or environment), where "
                "it does not meet the nodes of this one",
                command.label,
            )
            return self._processes.start(command, listener)
        for folder in map(str, command.program.search):
            if folder not in sys.path:
                sys.path.insert(0, folder)
        running = RunningThread(
            make_program(command.program, command.argv),
            listener,
            lambda program, on_end: RunningProgram(program, self.graph, on_end),
        )
        running.start()
        return running

    def close(self) -> None:
        self._stack.close()
        self._processes.close()
        self.graph.close()


def make_program(program: PythonProgram, argv: tuple[str, ...]) -> Program:
    """What ``navette run`` would run."""
    arguments = argv[1:]
    if program.file is not None:
        return script(program.file, arguments)
    return entry_point(program.module, program.function, arguments, name=argv[0])


class RunningThread:
    """A program of this process under way.

    Args:
        program: what to run.
        listener: is told of output and end, from the program's threads.
        make: makes the thread, given the program and what to call at its end.
    """

    def __init__(
        self,
        program: Program,
        listener: Listener,
        make: Callable[[Program, Callable[[int], object]], RunningProgram],
    ) -> None:
        self._listener = listener
        self._input: SimpleQueue[bytes] = SimpleQueue()
        self._over = False
        self._lock = Lock()
        self._running = make(
            replace(program, main=lambda: self._main(program)), self._end
        )

    @property
    def pid(self) -> int:
        return os.getpid()

    def start(self) -> None:
        self._running.start()

    def signal(self, number: int) -> None:
        """SIGINT interrupts, SIGTERM shuts down, SIGKILL leaves the thread behind.

        A thread cannot be ended from outside; it goes with the process.
        """
        if number == INTERRUPT:
            self._running.interrupt()
        elif number == KILL:
            self._end(LEFT_BEHIND)
        else:
            self._running.shut_down()

    def write(self, data: bytes) -> None:
        self._input.put(data)

    def _main(self, program: Program) -> object:
        program_output.set(self._listener.output)
        program_input.set(self._input)
        return program.main()

    def _end(self, code: int) -> None:
        with self._lock:
            was_over, self._over = self._over, True
        if not was_over:
            self._listener.exited(code)
