"""Disk space reserved for the end of a file."""

import os
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO

_STEP_BYTES = 8 * 1024


class Reserve:
    """An unnamed temporary file that occupies space until it is released.

    The operating system deletes it when the process ends. If it cannot be created,
    nothing is reserved.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._file: IO[bytes] | None = None
        self.size = 0

    def grow(self, size: int) -> None:
        """Reserve at least ``size`` bytes.

        Raises:
            OSError: the disk is full; the earlier reservation stays.
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
            # Not zeros, which a compressing file system would not store.
            self.size += self._file.write(os.urandom(wanted - self.size))

    def release(self) -> None:
        if self._file is not None:
            self._file.close()
        self._file, self.size = None, 0
