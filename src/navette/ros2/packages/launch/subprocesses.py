"""Commands as processes, each in a group of its own; none outlives the launch."""

import sys

from navette.ros2.packages.launch.errors import LaunchError
from navette.ros2.packages.launch.running import Command, PythonProgram
from navette.supervisor import (
    ChildProcess,
    Keeper,
    Listener,
    ProcessError,
    StartOptions,
)


class SubprocessRunner:
    """Starts a process for each command."""

    graph = None

    def __init__(self, keeper: Keeper | None = None) -> None:
        self.keeper = keeper or Keeper()

    def start(self, command: Command, listener: Listener) -> ChildProcess:
        words = command.words
        if command.program is not None:
            inside = program_words(command.program)
            words = [*command.prefix, *inside, *command.argv[1:]]
        options = StartOptions(cwd=command.cwd, env=command.env, shell=command.shell)
        try:
            return self.keeper.start(words, listener, options)
        except ProcessError as error:
            raise LaunchError(f"{command.label}: {error}") from error

    def close(self) -> None:
        """End what there still is."""
        self.keeper.close()


def program_words(program: PythonProgram) -> list[str]:
    """The command line that runs a Python program in a process of its own.

    ``navette run`` gives it ROS 2's module names.
    """
    target = (
        str(program.file)
        if program.file is not None
        else f"{program.module}:{program.function}"
    )
    search = [word for folder in program.search for word in ("--path", str(folder))]
    # -u: what a program prints is seen when it prints it.
    return [sys.executable, "-u", "-m", "navette", "run", *search, target]
