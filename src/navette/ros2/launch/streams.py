"""Standard output and error of programs that share this process.

The output of a program goes to its listener; all other output is unchanged.
"""

import io
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TextIO

Write = Callable[[str, bytes], None]
"""Receives ``stdout`` or ``stderr``, and the data written to it."""

program_output: ContextVar[Write | None] = ContextVar("program_output", default=None)


class ProgramStream(io.TextIOBase):
    """Text stream that passes the output of each program to its listener.

    Args:
        name: ``stdout`` or ``stderr``.
        outside: receives all other output.
    """

    def __init__(self, name: str, outside: TextIO) -> None:
        self._name = name
        self._outside = outside

    @property
    def encoding(self) -> str:  # type: ignore[override] # a constant here
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
    """Pass the output of programs to their listeners while the block runs."""
    before = sys.stdout, sys.stderr
    sys.stdout = ProgramStream("stdout", before[0])
    sys.stderr = ProgramStream("stderr", before[1])
    try:
        yield
    finally:
        sys.stdout, sys.stderr = before
