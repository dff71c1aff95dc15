"""The seam between actions and whatever runs their commands."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from navette.runtime.graph import Graph
from navette.supervisor import INTERRUPT, KILL, TERMINATE, Listener

__all__ = [
    "INTERRUPT",
    "KILL",
    "TERMINATE",
    "Command",
    "Listener",
    "PythonProgram",
    "Runner",
    "Running",
]


@dataclass(frozen=True)
class PythonProgram:
    """Python code that can run in this process as well as in one of its own.

    Either ``module`` and ``function``, or ``file`` to be run as ``__main__``.
    """

    module: str = ""
    function: str = ""
    file: Path | None = None
    #: Folders to look for modules in, before all others.
    search: tuple[Path, ...] = ()


@dataclass(frozen=True)
class Command:
    """A command line with everything worked out.

    ``env`` None means the launch's own environment. With ``program``, ``argv`` is what
    that finds in ``sys.argv``; it may run in this process unless ``own_process``.
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
        """The command line, as a person would type it."""
        return [*self.prefix, *self.argv]


class Running(Protocol):
    """A command under way."""

    @property
    def pid(self) -> int: ...

    def signal(self, number: int) -> None:
        """Send a signal to it and all that it started; after its end: nothing."""

    def write(self, data: bytes) -> None:
        """To its standard input."""


class Runner(Protocol):
    """Starts commands.

    ``graph``: where nodes that it starts in this process meet; None: it starts none.
    """

    @property
    def graph(self) -> Graph | None: ...

    def start(self, command: Command, listener: Listener) -> Running:
        """Start one.

        Raises:
            LaunchError: it cannot be started; says why.
        """

    def close(self) -> None:
        """After everything ended."""
