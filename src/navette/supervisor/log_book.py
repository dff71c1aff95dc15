"""What all processes of a project wrote, in one file, line by line in their order.

A line of JSON each: ``t`` (nanoseconds), ``module``, ``name``, ``text``, and
``event: true`` for what the supervisor itself has to say of the process.
"""

import json
import os
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import IO

FILE_NAME = "log.jsonl"
_OLD_NAME = "log.1.jsonl"
_MOST_BYTES = 8 << 20
_LONGEST_TEXT = 1 << 16


@dataclass(frozen=True)
class LogLine:
    """A line of a process."""

    t: int
    module: str
    name: str
    text: str
    event: bool = False

    @property
    def label(self) -> str:
        return self.name if self.name == self.module else f"{self.module}/{self.name}"


class LogBook:
    """Writes the file; from any thread. Of the old lines it keeps some 8 to 16 MB."""

    def __init__(self, folder: Path, now_ns: Callable[[], int]) -> None:
        self._folder = folder
        self._now_ns = now_ns
        self._lock = threading.Lock()
        self._file = self._open()

    def write(
        self, module: str, name: str, texts: Iterable[str], *, event: bool = False
    ) -> None:
        """Add lines, as of now."""
        now_ns = self._now_ns()
        lines = [
            LogLine(now_ns, module, name, text[:_LONGEST_TEXT], event) for text in texts
        ]
        data = "".join(f"{json.dumps(asdict(line))}\n" for line in lines)
        # A disk that is full costs lines, not the processes that wrote them.
        with self._lock, suppress(OSError):
            if not self._file.closed:
                self._file.write(data.encode())
                self._turn_over()

    def _turn_over(self) -> None:
        if self._file.tell() > _MOST_BYTES:
            self._file.close()
            (self._folder / FILE_NAME).replace(self._folder / _OLD_NAME)
            self._file = self._open()

    def close(self) -> None:
        with self._lock:
            self._file.close()

    def _open(self) -> IO[bytes]:
        path = self._folder / FILE_NAME
        descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
        return os.fdopen(descriptor, "ab", buffering=0)


class LogReader:
    """Reads what was written, and what is being written.

    Args:
        folder: of the log book; nothing may be there yet.
        wanted: which lines to give.
    """

    def __init__(self, folder: Path, wanted: Callable[[LogLine], bool]) -> None:
        self._folder = folder
        self._wanted = wanted
        self._file: IO[bytes] | None = None
        self._rest = b""

    def last(self, count: int | None) -> list[LogLine]:
        """The last lines so far (None: all there are); the next come after these."""
        old = self._folder / _OLD_NAME
        found = list(self._lines(old.read_bytes())) if old.is_file() else []
        found += self.new()
        return found if count is None else found[-count:] if count else []

    def new(self) -> list[LogLine]:
        """Lines that came since."""
        found = list(self._read_on())
        if self._was_replaced():
            self.close()
            found += self._read_on()
        return found

    def close(self) -> None:
        if self._file is not None:
            self._file.close()
            self._file = None

    def _read_on(self) -> Iterator[LogLine]:
        path = self._folder / FILE_NAME
        if self._file is None:
            if not path.is_file():
                return
            self._file = path.open("rb")
        *lines, self._rest = (self._rest + self._file.read()).split(b"\n")
        for line in lines:
            yield from self._lines(line)

    def _was_replaced(self) -> bool:
        path = self._folder / FILE_NAME
        if self._file is None or not path.is_file():
            return False
        return path.stat().st_ino != os.fstat(self._file.fileno()).st_ino

    def _lines(self, data: bytes) -> Iterator[LogLine]:
        for text in data.splitlines():
            line = _parse(text)
            if line is not None and self._wanted(line):
                yield line


def _parse(text: bytes) -> LogLine | None:
    """None for half a line, as a machine that lost its power leaves one."""
    try:
        return LogLine(**json.loads(text))
    except (ValueError, TypeError):
        return None
