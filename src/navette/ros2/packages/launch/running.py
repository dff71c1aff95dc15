"""Interface between actions and the runner that starts their commands."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from navette.runtime.graph import Graph
from navette.supervisor import ProcessHandle


@dataclass(frozen=True)
class PythonProgram:
    """Python code that can run in this process or in one of its own.

    Attributes:
        module, function: what to call; or
        file: what to run as ``__main__``.
        search: folders that precede the import path.
    """

    module: str = ""
    function: str = ""
    file: Path | None = None
    search: tuple[Path, ...] = ()


@dataclass(frozen=True)
class LaunchCommand:
    """A command with all substitutions performed.

    Attributes:
        label: unique name, as ``talker-1``.
        env: its whole environment; None: that of the launch.
        program: Python code to run instead of ``argv[0]``; it gets ``argv`` as
            ``sys.argv``.
        own_process: the program cannot run in this process.
    """

    label: str
    argv: tuple[str, ...]
    prefix: tuple[str, ...] = ()
    cwd: str | None = None
    env: Mapping[str, str] | None = None
    shell: bool = False
    tty: bool = False
    program: PythonProgram | None = None
    own_process: bool = False

    @property
    def words(self) -> list[str]:
        """The command line as typed in a terminal."""
        return [*self.prefix, *self.argv]


class Runner(Protocol):
    """Starts commands.

    ``graph`` connects the nodes that the runner starts in this process; None if it
    starts processes only.
    """

    @property
    def graph(self) -> Graph | None: ...

    def start(self, command: LaunchCommand) -> ProcessHandle:
        """Start a command.

        Raises:
            ProcessError: it cannot be started.
        """

    def close(self) -> None:
        """Release resources, after all commands have ended."""
