"""Standard output and error of programs that share this process.

Each program's prints go to whoever listens to that program; what is printed outside
of programs goes where it always went.
"""

import io
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TextIO

Write = Callable[[str, bytes], None]
"""Takes ``stdout`` or ``stderr`` and what was written."""

program_output: ContextVar[Write | None] = ContextVar("program_output", default=None)


class ProgramStream(io.TextIOBase):
    """A text stream that gives each program its own output.

    Args:
        name: ``stdout`` or ``stderr``.
        outside: for whatever is no program's.
    """

    def __init__(self, name: str, outside: TextIO) -> None:
        self._name = name
        self._outside = outside

    @property
    def encoding(self) -> str:  # type: ignore[override]
        return "utf-8"

    def writable(self) -> bool:
        return True

    def write(self, text: str) -> int:
        write = program_output.get()
        if write is None:
            return self._outside.write(text)
        write(self._name, text.encode("utf-8", "replace"))
        return len(text)

    def flush(self) -> None:
        if program_output.get() is None:
            self._outside.flush()

    def isatty(self) -> bool:
        return program_output.get() is None and self._outside.isatty()

    def fileno(self) -> int:
        return self._outside.fileno()


@contextmanager
def program_streams() -> Iterator[None]:
    """Let ``print`` of a program reach that program's listener."""
    before = sys.stdout, sys.stderr
    sys.stdout = ProgramStream("stdout", before[0])
    sys.stderr = ProgramStream("stderr", before[1])
    try:
        yield
    finally:
        sys.stdout, sys.stderr = before
