"""Create a recording's file so that two writers never share it.

The file is created under a temporary name (``.NAME.part``) and locked; it takes its own
name when its first bytes are written, by an operation that fails if another file took
the name meanwhile. The lock lasts as long as the file is open, also in a process that
is killed, and does not affect readers.
"""

import errno
import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import FileIO
from pathlib import Path

from navette.bags.mcap_records import MAGIC
from navette.errors import FileFormatError
from navette.files.writing import writing

_ATTEMPTS = 10
_CANNOT_LOCK = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.EINVAL)
_CANNOT_LINK = (errno.EPERM, errno.ENOSYS, errno.EOPNOTSUPP, errno.EMLINK)


class RecordingFile:
    """A new file that no other recorder writes, with its first bytes.

    Args:
        start: first bytes; the file appears under its name with these.
        overwrite: replace an existing file; an empty file is always replaced.

    Raises:
        FileFormatError: the file exists, is being recorded, or cannot be created.
    """

    def __init__(self, path: Path, start: bytes, *, overwrite: bool) -> None:
        self.path = path
        # The file a symbolic link refers to is replaced, not the link.
        self._target = Path(os.path.realpath(path))
        with writing(path):
            _refuse_existing(path, overwrite=overwrite)
            part = self._target.with_name(f".{self._target.name}.part")
            self.raw = _create_locked(path, part)
            try:
                self.raw.truncate(0)
                self.raw.write(start)
                self._take_name(part, overwrite=overwrite)
            except BaseException:
                with suppress(OSError):
                    part.unlink()
                self.raw.close()
                raise

    def check(self, size: int) -> None:
        """Raise if the name refers to another file or to none, or the file is shorter.

        Args:
            size: bytes written so far.

        Raises:
            OSError: messages written from now on would be lost.
        """
        try:
            now = self._target.stat()
        except FileNotFoundError:
            raise OSError(
                errno.ENOENT, "the file was removed or renamed by another program"
            ) from None
        own = os.fstat(self.raw.fileno())
        if (now.st_dev, now.st_ino) != (own.st_dev, own.st_ino):
            raise OSError(errno.ESTALE, "the file was replaced by another program")
        if own.st_size < size:
            raise OSError(errno.ESTALE, "the file was truncated by another program")

    def _take_name(self, part: Path, *, overwrite: bool) -> None:
        if overwrite or _is_empty(self._target):
            if is_being_recorded(self._target):
                raise busy(self.path)
            part.replace(self._target)
            return
        try:
            self._target.hardlink_to(part)
        except FileExistsError:
            raise exists_already(self.path) from None
        except OSError as error:  # a file system without links
            if error.errno not in _CANNOT_LINK:
                raise
            if self._target.exists():
                raise exists_already(self.path) from None
            part.replace(self._target)
        else:
            part.unlink()


def is_being_recorded(path: Path) -> bool:
    """Whether a running process records this file, or a file in this folder."""
    if path.is_dir():
        return any(is_being_recorded(each) for each in path.glob("*.mcap"))
    if not path.is_file():
        return False
    with _opened(path) as descriptor:
        return descriptor is not None and not _lock(descriptor, fcntl.LOCK_SH)


@contextmanager
def _opened(path: Path) -> Iterator[int | None]:
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    except OSError:
        yield None
        return
    try:
        yield descriptor
    finally:
        os.close(descriptor)


def _refuse_existing(path: Path, *, overwrite: bool) -> None:
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    if not path.exists():
        return
    if not path.is_file():
        raise FileFormatError(path, "exists, is not a bag and is not replaced")
    if is_being_recorded(path):
        raise busy(path)
    if _is_empty(path):
        return
    with path.open("rb") as file:
        if file.read(len(MAGIC)) != MAGIC:
            raise FileFormatError(path, "exists, is not a bag and is not replaced")
    if not overwrite:
        raise exists_already(path)


def _create_locked(path: Path, part: Path) -> FileIO:
    """Create and lock the temporary file; one left by a killed process is reused."""
    for _ in range(_ATTEMPTS):
        flags = os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW
        raw = FileIO(os.open(part, flags, 0o666), "r+")
        if not _lock(raw.fileno(), fcntl.LOCK_EX):
            raw.close()
            raise busy(path)
        with suppress(FileNotFoundError):
            if os.path.samestat(part.stat(), os.fstat(raw.fileno())):
                return raw
        raw.close()  # renamed between opening and locking
    raise busy(path)


def _lock(descriptor: int, kind: int) -> bool:
    """Lock a file, where the file system can; False if another process has it."""
    try:
        fcntl.flock(descriptor, kind | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError as error:
        if error.errno not in _CANNOT_LOCK:
            raise
    return True


def _is_empty(path: Path) -> bool:
    return path.is_file() and path.stat().st_size == 0


def exists_already(path: Path) -> FileFormatError:
    """Return the error of a path that may not be replaced."""
    return FileFormatError(path, "exists already; --overwrite replaces it")


def busy(path: Path) -> FileFormatError:
    """Return the error of a file that another process writes."""
    return FileFormatError(
        path, "is being recorded by another recorder; give another name"
    )
