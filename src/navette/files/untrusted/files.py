"""Opening and reading of untrusted files."""

import os
import stat
from io import BufferedReader
from pathlib import Path

from navette.errors import FileFormatError
from navette.files.untrusted.budget import Budget

_KINDS = {
    stat.S_IFDIR: "a folder",
    stat.S_IFIFO: "a named pipe",
    stat.S_IFSOCK: "a socket",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
}


def open_regular(path: Path) -> BufferedReader:
    """Open a file that can be read at any position.

    Raises:
        FileFormatError: missing, not readable, or a pipe, socket or device, which might
            never return.
    """
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    except OSError as error:
        raise FileFormatError(path, f"cannot be opened: {error.strerror}") from error
    kind = stat.S_IFMT(os.fstat(descriptor).st_mode)
    if kind != stat.S_IFREG:
        os.close(descriptor)
        found = _KINDS.get(kind, "not a regular file")
        raise FileFormatError(path, f"is {found}; expected a regular file")
    return os.fdopen(descriptor, "rb")


def read_bounded(path: Path, budget: Budget) -> bytes:
    """Read a whole file, also from a pipe (``<(command)`` in a shell).

    Raises:
        FileFormatError: missing, not readable, or larger than the budget.
    """
    try:
        with path.open("rb") as file:
            data = file.read(budget.octets + 1)
    except OSError as error:
        raise FileFormatError(path, f"cannot be read: {error.strerror}") from error
    except ValueError as error:  # a name that no file can have
        raise FileFormatError(path, f"cannot be read: {error}") from error
    if len(data) > budget.octets:
        raise FileFormatError(path, f"more than {budget.octets} bytes; not read")
    return data
