"""Log of a project: the output of all its processes in one file, in order.

Each line is a JSON object: ``t`` (nanoseconds), ``service``, ``name``, ``text``, and
``event: true`` for a line of the supervisor itself.
"""

import json
import os
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import IO

from navette.supervisor.service_config import process_label
from navette.transports.clock import NanosecondClock

FILE_NAME = "log.jsonl"
_OLD_NAME = "log.1.jsonl"
_MAX_BYTES = 8 << 20
_MAX_TEXT = 1 << 16


@dataclass(frozen=True)
class LogLine:
    """A line of output, or an event of the supervisor."""

    t: int
    service: str
    name: str
    text: str
    event: bool = False

    @property
    def label(self) -> str:
        return process_label(self.service, self.name)


class LogStore:
    """Writer of the log, for any thread; keeps the last 8 to 16 MB.

    On a full disk lines are lost, and the processes continue. The log contains how many
    as soon as there is space again.
    """

    def __init__(self, folder: Path, clock: NanosecondClock) -> None:
        self._folder = folder
        self._clock = clock
        self._lock = threading.Lock()
        self._file = self._open()
        self._lost = 0
        self.problem = ""  # why the last lines were not stored

    def write(
        self, service: str, name: str, texts: Iterable[str], *, event: bool = False
    ) -> None:
        """Append lines with the current time."""
        now_ns = self._clock.now_ns
        lines = [
            LogLine(now_ns, service, name, text[:_MAX_TEXT], event) for text in texts
        ]
        with self._lock:
            if self._file.closed:
                return
            try:
                if self.problem:
                    text = f"{self._lost} lines are not in the log: {self.problem}"
                    # The last line may be incomplete.
                    self._append(b"\n")
                    self._append(_encode(LogLine(now_ns, service, name, text, True)))
                    self._lost, self.problem = 0, ""
                self._append(b"".join(map(_encode, lines)))
                self._rotate()
            except OSError as error:
                self._lost += len(lines)
                self.problem = error.strerror or str(error)

    def _append(self, data: bytes) -> None:
        while data:
            data = data[self._file.write(data) :]

    def _rotate(self) -> None:
        if self._file.tell() > _MAX_BYTES:
            (self._folder / FILE_NAME).replace(self._folder / _OLD_NAME)
            full, self._file = self._file, self._open()
            full.close()

    def close(self) -> None:
        with self._lock:
            self._file.close()

    def _open(self) -> IO[bytes]:
        path = self._folder / FILE_NAME
        descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
        return os.fdopen(descriptor, "ab", buffering=0)


def _encode(line: LogLine) -> bytes:
    return json.dumps(asdict(line)).encode() + b"\n"


AcceptLine = Callable[[LogLine], bool]
"""Whether a reader returns a line."""


class LogReader:
    """Reader of the log, also while it is written.

    Args:
        folder: of the log; it may not exist yet.
        accept: default: returns every line.
    """

    def __init__(self, folder: Path, *, accept: AcceptLine = lambda line: True) -> None:
        self._folder = folder
        self._accept = accept
        self._file: IO[bytes] | None = None
        self._rest = b""

    def last(self, count: int | None) -> list[LogLine]:
        """Return the last lines (None: all); :meth:`new` continues after them."""
        old = self._folder / _OLD_NAME
        found = list(self._parse(old.read_bytes())) if old.is_file() else []
        found += self.new()
        return found if count is None else found[-count:] if count else []

    def new(self) -> list[LogLine]:
        """Return the lines written since the last call."""
        found = list(self._read_on())
        if self._was_rotated():
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
            yield from self._parse(line)

    def _was_rotated(self) -> bool:
        path = self._folder / FILE_NAME
        if self._file is None or not path.is_file():
            return False
        return path.stat().st_ino != os.fstat(self._file.fileno()).st_ino

    def _parse(self, data: bytes) -> Iterator[LogLine]:
        for text in data.splitlines():
            # A power failure leaves an incomplete line.
            with suppress(ValueError, TypeError):
                line = LogLine(**json.loads(text))
                if self._accept(line):
                    yield line
