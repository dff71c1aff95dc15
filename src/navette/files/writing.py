"""Failures to write a file, as errors that name it."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from navette.errors import FileFormatError


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Raise a failure to write a file, or its folder, as an error of Navette.

    Raises:
        FileFormatError: names the path and the reason.
    """
    try:
        yield
    except OSError as error:
        reason = error.strerror or str(error)
        raise FileFormatError(path, f"cannot be written: {reason}") from error
