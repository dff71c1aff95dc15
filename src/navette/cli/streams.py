"""Standard streams of a command: closed, of any encoding, or on a full disk."""

import errno
import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from navette.cli.stderr import print_error

_FAILED = 1
_WRITING = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EBADF}


def prepare() -> None:
    """Make every character printable, and replace closed streams by ``os.devnull``."""
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, Path(os.devnull).open(mode))  # noqa: SIM115 - until the process ends
    if isinstance(sys.stdout, io.TextIOWrapper):
        # As Python's own stderr: the encoding may lack even the doctor's tick.
        sys.stdout.reconfigure(errors="backslashreplace")


@contextmanager
def reporting_failed_writes() -> Iterator[None]:
    """End the command with a line and exit code 1 if output cannot be written."""
    try:
        try:
            yield
        except SystemExit:
            with suppress(BrokenPipeError):
                sys.stdout.flush()  # a failure at exit would only be a warning
            raise
    except OSError as error:
        if error.filename is not None or error.errno not in _WRITING:
            raise
        sys.stdout = Path(os.devnull).open("w")  # noqa: SIM115 - for the flush at exit
        print_error(f"cannot write the output: {error.strerror}")
        raise SystemExit(_FAILED) from None
