"""A bag's file in pieces: lengths checked, and a way on behind what is broken."""

import re
import struct
from collections.abc import Callable
from pathlib import Path

from navette.errors import DecodeError, FileFormatError

_BLOCK = 1 << 20
_MOST_PROBLEMS = 100


class BinaryFile:
    """Reads pieces of the file; a piece that is not there is a named error.

    Raises:
        FileFormatError: there is no such file, or it cannot be read.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            self._stream = path.open("rb")
            self.size = path.stat().st_size
        except OSError as error:
            raise FileFormatError(
                path, f"cannot be opened: {error.strerror}"
            ) from error

    def read(self, position: int, length: int) -> bytes:
        """Exactly ``length`` bytes."""
        if position < 0 or length < 0 or position + length > self.size:
            raise self.error(
                position, f"wants {length} bytes; the file ends at {self.size}"
            )
        self._stream.seek(position)
        found = self._stream.read(length)
        if len(found) != length:
            raise self.error(position, f"{len(found)} bytes of {length} could be read")
        return found

    def find(
        self,
        start: int,
        pattern: re.Pattern[bytes],
        wanted: Callable[[int], int | None],
    ) -> int | None:
        """What ``wanted`` makes of the first match at or behind ``start`` it takes.

        Args:
            pattern: of at most eight bytes.
            wanted: given a match's position, what was looked for; None if it is not.
        """
        position = start
        while position < self.size:
            block = self.read(position, min(_BLOCK, self.size - position))
            for match in pattern.finditer(block):
                found = wanted(position + match.start())
                if found is not None:
                    return found
            if position + len(block) >= self.size:
                break
            position += len(block) - 8  # a match may lie across
        return None

    def error(self, position: int, reason: str) -> FileFormatError:
        """Names file and byte."""
        return FileFormatError(self.path, f"byte {position}: {reason}")

    def close(self) -> None:
        """Close the file."""
        self._stream.close()


def walk(
    file: BinaryFile,
    start: int,
    visit: Callable[[int], int | None],
    next_sound: Callable[[int], int | None],
    problems: list[str],
) -> None:
    """Go from record to record to the end.

    Args:
        visit: takes in the record there; the position behind it, None at the end.
        next_sound: where it goes on behind a broken record; None if nowhere.
        problems: what is wrong on the way is added.
    """
    position = start
    while position < file.size:
        try:
            after = visit(position)
        except (FileFormatError, DecodeError) as error:
            after = next_sound(position + 1)
            where = "the rest is lost" if after is None else f"on at {after}"
            problems.append(f"broken record ({reason_of(error)}); {where}")
            if len(problems) > _MOST_PROBLEMS:
                problems.append("too much is broken; given up")
                return
        if after is None:
            return
        position = after


def reason_of(error: FileFormatError | DecodeError | struct.error) -> str:
    """Without the file's name."""
    return error.reason if isinstance(error, FileFormatError) else str(error)
