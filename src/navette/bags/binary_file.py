"""Checked reads from a bag file, and resynchronisation after damaged records."""

import os
import re
import struct
from collections.abc import Callable
from pathlib import Path

from navette.errors import DecodeError, FileFormatError
from navette.files.untrusted.files import open_regular

_BLOCK = 1 << 20
_MOST_PROBLEMS = 100


class BinaryFile:
    """Reads parts of a file; a part outside it is a FileFormatError.

    Raises:
        FileFormatError: the file does not exist or cannot be read.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._stream = open_regular(path)
        self.size = os.fstat(self._stream.fileno()).st_size

    def read(self, position: int, length: int) -> bytes:
        if position < 0 or length < 0 or position + length > self.size:
            raise self.error(
                position, f"{length} bytes expected, but the file ends at {self.size}"
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
        """Return the first accepted match at or after ``start``.

        Args:
            pattern: at most eight bytes.
            wanted: converts a match's position to the result; None rejects it.
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
            position += len(block) - 8  # a match may span two blocks
        return None

    def error(self, position: int, reason: str) -> FileFormatError:
        return FileFormatError(self.path, f"byte {position}: {reason}")

    def close(self) -> None:
        self._stream.close()


def walk(
    file: BinaryFile,
    start: int,
    visit: Callable[[int], int | None],
    next_sound: Callable[[int], int | None],
    problems: list[str],
) -> None:
    """Visit all records up to the end of the file.

    Args:
        visit: processes the record at a position; returns the next, None at the end.
        next_sound: position to resume after a damaged record; None if there is none.
        problems: receives a text for each damaged part.
    """
    position = start
    while position < file.size:
        try:
            after = visit(position)
        except (FileFormatError, DecodeError) as error:
            after = next_sound(position + 1)
            where = "the rest is lost" if after is None else f"resumed at {after}"
            problems.append(f"damaged record ({reason_of(error)}); {where}")
            if len(problems) > _MOST_PROBLEMS:
                problems.append("too many damaged records; gave up")
                return
        if after is None:
            return
        position = after


def reason_of(error: FileFormatError | DecodeError | struct.error) -> str:
    """Return the reason without the file name."""
    return error.reason if isinstance(error, FileFormatError) else str(error)
