"""Room on the disk that is kept for the end of a file."""

import os
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO

_STEP_BYTES = 8 * 1024


class Reserve:
    """A file without a name that takes up space until it is given back.

    With the process, however that ends, it is gone. Where no such file can be made
    nothing is kept.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._file: IO[bytes] | None = None
        self.size = 0

    def grow(self, size: int) -> None:
        """Keep at least ``size`` bytes.

        Raises:
            OSError: the disk is full; what was kept before still is.
        """
        if size <= self.size:
            return
        if self._file is None:
            with suppress(OSError):
                self._file = TemporaryFile(  # noqa: SIM115 (outlives this call)
                    dir=self._folder, buffering=0
                )
        if self._file is None:
            return
        wanted = (size // _STEP_BYTES + 1) * _STEP_BYTES
        while self.size < wanted:
            # Not zeros: file systems that compress would keep no room for them.
            self.size += self._file.write(os.urandom(wanted - self.size))

    def release(self) -> None:
        """Give the room back."""
        if self._file is not None:
            self._file.close()
        self._file, self.size = None, 0
