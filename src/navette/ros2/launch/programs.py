"""Runner that runs Python programs as threads of this process."""

import os
import sys
from contextlib import ExitStack
from dataclasses import replace
from threading import Lock

from navette.ros2.launch.streams import program_output, program_streams
from navette.ros2.names.blocking_calls import cooperative_blocking_calls
from navette.ros2.names.process import RunningProgram, program_threads
from navette.ros2.names.program import Program, entry_point, script
from navette.ros2.packages.launch.logging import get_logger
from navette.ros2.packages.launch.running import LaunchCommand, PythonProgram
from navette.ros2.packages.launch.subprocesses import SubprocessRunner
from navette.runtime.context import new_graph
from navette.runtime.graph import Graph
from navette.supervisor import INTERRUPT, KILL, ProcessHandle, ProcessListener

ABANDONED = -KILL

_log = get_logger("launch")


class InProcessRunner:
    """Runs Python programs as threads on one graph, other commands as processes."""

    def __init__(self) -> None:
        self.graph = new_graph()
        self._processes = SubprocessRunner()
        self._stack = ExitStack()
        # The processes that the programs start end with the launch as well.
        self._stack.enter_context(self._processes.manager.adopt_children())
        self._stack.enter_context(program_threads())
        self._stack.enter_context(cooperative_blocking_calls())
        self._stack.enter_context(program_streams())

    def start(self, command: LaunchCommand) -> ProcessHandle:
        if command.program is None:
            return self._processes.start(command)
        if command.own_process:
            _log.warning(
                "%s runs in a process of its own (prefix, cwd or environment) and does "
                "not see the nodes of this process",
                command.label,
            )
            return self._processes.start(command)
        for folder in map(str, command.program.search):
            if folder not in sys.path:
                sys.path.insert(0, folder)
        return ProgramThread(make_program(command.program, command.argv), self.graph)

    def close(self) -> None:
        self._stack.close()
        self._processes.close()
        self.graph.close()


def make_program(program: PythonProgram, argv: tuple[str, ...]) -> Program:
    """Return the program that ``navette run`` would run."""
    arguments = argv[1:]
    if program.file is not None:
        return script(program.file, arguments)
    return entry_point(program.module, program.function, arguments, name=argv[0])


class ProgramThread:
    """Process handle of a program that runs as a thread of this process."""

    def __init__(self, program: Program, graph: Graph) -> None:
        self._program = program
        self._listener: ProcessListener | None = None
        self._over = False
        self._lock = Lock()
        self._running = RunningProgram(
            replace(program, main=self._main), graph, on_end=self._exit
        )

    @property
    def pid(self) -> int:
        return os.getpid()

    def watch(self, listener: ProcessListener) -> None:
        """Run the program and report its output and exit."""
        self._listener = listener
        self._running.start()

    def signal(self, number: int) -> None:
        """Interrupt (SIGINT), shut down (SIGTERM) or abandon (SIGKILL) the program.

        A thread cannot be ended from outside; it ends with the process.
        """
        if number == INTERRUPT:
            self._running.interrupt()
        elif number == KILL:
            self._exit(ABANDONED)
        else:
            self._running.shut_down()

    def write(self, data: bytes) -> None:
        _log.warning(
            "%s shares the standard input of this process; %d bytes for it are "
            "dropped (navette launch --processes gives it one of its own)",
            self._program.name,
            len(data),
        )

    def _main(self) -> object:
        assert self._listener is not None, "runs after watch()"
        program_output.set(self._listener.output)
        return self._program.main()

    def _exit(self, code: int) -> None:
        with self._lock:
            was_over, self._over = self._over, True
        if not was_over and self._listener is not None:
            self._listener.exited(code)
