"""Runner that starts a process for each command."""

import sys

from navette.ros2.packages.launch.ros2_command import with_ros2
from navette.ros2.packages.launch.running import LaunchCommand, PythonProgram
from navette.supervisor import (
    ChildProcess,
    ProcessManager,
    StartOptions,
)


class SubprocessRunner:
    """Starts a process for each command; none outlives the launch."""

    graph = None

    def __init__(self, manager: ProcessManager | None = None) -> None:
        self.manager = manager or ProcessManager()

    def start(self, command: LaunchCommand) -> ChildProcess:
        argv = command.words
        if command.program is not None:
            program = program_argv(command.program)
            argv = [*command.prefix, *program, *command.argv[1:]]
        env = with_ros2(command.env)
        options = StartOptions(cwd=command.cwd, env=env, shell=command.shell)
        return self.manager.start(argv, options)

    def close(self) -> None:
        self.manager.close()


def program_argv(program: PythonProgram) -> list[str]:
    """Return the command line of a Python program in a process of its own.

    ``navette run`` provides ROS 2's module names.
    """
    target = (
        str(program.file)
        if program.file is not None
        else f"{program.module}:{program.function}"
    )
    search = [word for folder in program.search for word in ("--path", str(folder))]
    # -u: output appears when it is printed.
    return [sys.executable, "-u", "-m", "navette", "run", *search, target]
